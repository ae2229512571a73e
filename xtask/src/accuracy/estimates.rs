//! Estimates of errors against the errors themselves, over scenes of chance.

use tetrascope::{ErrorFigures, Integration, OrderMethod, Plan, Silent, TableSettings};
use tetrascope_tests::scenes::random_scene;

use crate::Failure;

pub(super) fn run(scenes: u64) -> Result<(), Failure> {
    for seed in 0..scenes {
        let made = random_scene(seed);
        let field = made.volume.field(None)?;
        let mut completed = made.scene.complete(&field.facts)?;
        let base = field.plan(&mut completed)?;
        let exact = field.reference_picture(&base, &Silent)?;
        for (integration, order) in [
            (Integration::Exact, base.order),
            (Integration::Exact, OrderMethod::Centroid),
            (Integration::Exact, OrderMethod::KBuffer { window: 4 }),
            (Integration::Average, base.order),
            (Integration::Opacity2d, base.order),
            (Integration::Partial, base.order),
            (Integration::Cumulative, base.order),
            (Integration::Table2d, base.order),
            (Integration::Table3d, base.order),
            (Integration::Vertex, base.order),
        ] {
            if !integration.covers(base.model) {
                continue;
            }
            let plan = Plan { integration, order, tables: TableSettings::of(integration), ..base.clone() };
            let rendered = field.render(&plan, &Silent)?;
            let again = field.render(&plan, &Silent)?;
            let time: f64 = again.timings.iter().map(|(_, t)| t.as_secs_f64()).sum();
            let truth = ErrorFigures::between(&rendered.image, &exact).map_or(0.0, |f| f.largest);
            let start = std::time::Instant::now();
            let e = field.estimate_error(&plan, &rendered)?;
            let took = start.elapsed().as_secs_f64();
            println!(
                "{seed} {} {} {} {} truth {truth:.3e} expected {:.3e} ratio {:.3} bound {:.2e} parts {} ms {:.3} estms {:.3} frags {}",
                made.transfer,
                base.model,
                integration,
                order,
                e.expected,
                e.expected / truth,
                e.bound,
                e.parts
                    .map(|p| format!("{}:{:.1e}/{:.1e}", p.cause, p.expected, p.bound.unwrap_or(f64::NAN)))
                    .join(" "),
                time * 1e3,
                took * 1e3,
                rendered.counts.fragments
            );
        }
    }
    Ok(())
}

/// Times of methods on scenes of chance, one thread.
pub(super) fn costs(scenes: u64) -> Result<(), Failure> {
    for seed in 0..scenes {
        let mut made = random_scene(seed);
        (made.scene.image.width, made.scene.image.height) = (256, 192);
        let field = made.volume.field(None)?;
        let mut completed = made.scene.complete(&field.facts)?;
        completed.scene.threads = Some(1);
        let base = field.plan(&mut completed)?;
        let survey = field.survey(&base);
        let plans: Vec<Plan> = Integration::ALL
            .into_iter()
            .filter(|i| i.covers(base.model))
            .map(|integration| Plan { integration, tables: TableSettings::of(integration), ..base.clone() })
            .collect();
        let mut best = vec![f64::INFINITY; plans.len()];
        let mut raster = vec![f64::INFINITY; plans.len()];
        let mut counts = Vec::new();
        for turn in 0..6 {
            for (plan, (best, raster)) in plans.iter().zip(best.iter_mut().zip(&mut raster)) {
                let rendered = field.render(plan, &Silent)?;
                let time: f64 = rendered.timings.iter().map(|(_, t)| t.as_secs_f64()).sum();
                let last: f64 = rendered.timings.last().map_or(0.0, |(_, t)| t.as_secs_f64());
                if turn == 0 {
                    counts.push(rendered.counts);
                } else {
                    *best = best.min(time);
                    *raster = raster.min(last);
                }
            }
        }
        for (i, plan) in plans.iter().enumerate() {
            println!(
                "{seed} {} {} {} us {:.2} raster {:.2} frags {} drawn {} met {:.3} pieces {:.3} most {}",
                made.transfer,
                plan.model,
                plan.integration,
                best[i] * 1e6,
                raster[i] * 1e6,
                counts[i].fragments,
                counts[i].drawn,
                survey.pieces_met,
                survey.pieces,
                survey.most_pieces
            );
        }
    }
    Ok(())
}
