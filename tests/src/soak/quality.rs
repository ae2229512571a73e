//! Methods of chance: mostly left open, as users leave them.

use tetrascope::{Choice, CycleRemedy, Integration, Interpolation, IsosurfaceMethodName, OrderMethod, SceneFile};

use super::mesh::pick;
use crate::meshes::Random;

/// Gives a scene its methods.
pub(super) fn quality(random: &mut Random, scene: &mut SceneFile) {
    let quality = &mut scene.quality;
    if random.unit() < 0.3 {
        let integration = Integration::ALL[pick(random, Integration::ALL.len())];
        quality.integration = Choice::Named(integration);
        // Small: many are built, and none has to be accurate.
        match integration {
            Integration::Table2d => quality.table_size = Some(16 + pick(random, 48) as u32),
            Integration::Table3d => {
                quality.table_size = Some(8 + pick(random, 24) as u32);
                quality.table_lengths = Some(4 + pick(random, 12) as u32);
            }
            _ => {}
        }
    } else if random.unit() < 0.1 {
        quality.max_error = Some(10.0_f64.powf(-random.between(1.0, 4.0)));
    }
    if random.unit() < 0.4 {
        let order = match pick(random, 9) {
            0 => OrderMethod::None,
            1 => OrderMethod::Bucket { slabs: 1 + pick(random, 200) as u32 },
            2 => OrderMethod::Centroid,
            3 => OrderMethod::Power,
            4 => OrderMethod::Mpvo,
            5 => OrderMethod::KBuffer { window: 1 + pick(random, 12) as u32 },
            6 => OrderMethod::BspXmpvo,
            _ => OrderMethod::PerPixel,
        };
        quality.order = Choice::Named(order);
        match order {
            OrderMethod::Bucket { slabs } => quality.slabs = Some(slabs),
            OrderMethod::KBuffer { window } => quality.window = Some(window),
            OrderMethod::Mpvo | OrderMethod::BspXmpvo => {
                quality.cycles = (random.unit() < 0.6).then(|| CycleRemedy::ALL[pick(random, 3)]);
            }
            _ => {}
        }
    }
    if random.unit() < 0.07 {
        quality.interpolation = Choice::Named(Interpolation::ALL[pick(random, 3)]);
    }
    if !scene.isosurface.is_empty() && random.unit() < 0.15 {
        let by = [IsosurfaceMethodName::MapSmooth, IsosurfaceMethodName::MapStopped][pick(random, 2)];
        quality.isosurfaces = Some(by);
        quality.map_size = Some(16 + pick(random, 112) as u32);
    }
}
