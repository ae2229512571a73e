//! `tetrascope plan`: what would be done for a picture, what is left out, and what it takes; nothing is drawn.

mod rows;

use serde_json::{Value, json};
use tetrascope::{Volume, foresee_blank};

use crate::Failure;
use crate::args::PlanArgs;
use crate::interrupt;
use crate::progress::Bar;
use crate::render::wrong_scene;
use crate::report::{line, object, warning};
use crate::scene_of::scene_of;
use rows::{Row, Said};

pub(crate) fn run(args: &PlanArgs) -> Result<(), Failure> {
    let bar = Bar::new(false);
    let done = plan(args, &bar);
    bar.clear();
    let said = done?;
    said.warnings.iter().for_each(|text| warning(text));
    if args.json {
        object(&said.json);
    } else {
        let width = said.rows.iter().map(|row| row.subject.len()).max().unwrap_or(0) + 2;
        for Row { subject, text } in &said.rows {
            line(&format!("{subject:<width$}{text}"));
        }
    }
    Ok(())
}

fn plan(args: &PlanArgs, bar: &Bar) -> Result<Said, Failure> {
    let (scene, base_dir) = scene_of(&args.scene)?;
    let threads = args.scene.look.threads.map(usize::from);
    bar.step("reading and cutting into tetrahedra");
    let volume = Volume::of_section(&scene.mesh, &base_dir, bar.reading())?;
    interrupt::go_on()?;
    let field = volume.field_of_section(&scene.mesh)?;
    bar.step("choosing methods");
    let wrong = |error: tetrascope::Error| wrong_scene(args.scene.file(), error);
    let mut completed = scene.complete(&field.facts).map_err(|error| wrong(error.into()))?;
    completed.scene.threads = threads;
    let plan = field.plan(&mut completed).map_err(wrong)?;
    interrupt::go_on()?;
    let work = field.work(&plan)?;

    let mut blank = foresee_blank(&plan, &field.facts);
    if blank.is_empty() && work.drawn_at_most() == 0 {
        blank.push(format!(
            "of {} tetrahedra {} show nothing by the transfer function and the isosurfaces, and the others are out of view",
            work.cells, work.transparent
        ));
    }
    let mut said = rows::say(&volume, &field, &plan, &work, threads);
    said.warnings.extend(volume.warnings.iter().cloned());
    said.warnings.extend(volume.decomposition.counts.findings());
    said.warnings.extend(field.field.warnings.iter().cloned());
    said.warnings.extend(field.on_mesh.warning());
    said.warnings.extend(completed.warnings);
    said.warnings.extend(field.precision_warnings(&plan));
    if !blank.is_empty() {
        said.warnings.push(format!("the picture will be blank: {}", blank.join("; ")));
    }
    match field.check_memory(&plan, &[]) {
        Err(error @ tetrascope::Error::Memory(_)) => {
            said.warnings.push(format!("the picture will be refused: {error}"));
        }
        done => done?,
    }
    interrupt::go_on()?;
    if let Value::Object(all) = &mut said.json {
        all.insert("blank".to_owned(), json!(blank));
        all.insert("warnings".to_owned(), json!(said.warnings));
    }
    Ok(said)
}
