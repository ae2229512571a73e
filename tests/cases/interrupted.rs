//! Work that is given up gives no picture, and does no harm to the next one.

use std::sync::atomic::{AtomicU64, Ordering};

use tetrascope::mesh::rings_sample;
use tetrascope::{Error, Progress, SceneFile, Silent, Stage, Volume};
use tetrascope_tests::ways::Way;

/// Says after so many questions that the work is to be given up.
struct Patience {
    asked: AtomicU64,
    most: u64,
}

impl Patience {
    fn of(most: u64) -> Self {
        Self { asked: AtomicU64::new(0), most }
    }
}

impl Progress for Patience {
    fn report(&self, _stage: Stage, _done: u64, _total: u64) {}

    fn is_stopped(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) >= self.most
    }
}

fn bits(image: &tetrascope::LinearImage) -> Vec<u32> {
    image.pixels().iter().flatten().map(|channel| channel.to_bits()).collect()
}

#[test]
fn every_back_end_can_be_given_up_wherever_it_is_and_draws_the_same_picture_afterwards() {
    let volume = Volume::from_dataset(rings_sample(6), "rings").unwrap();
    let mut scene = SceneFile::of_mesh(tetrascope::SAMPLE);
    (scene.image.width, scene.image.height) = (70, 40);
    for way in Way::here("interrupted") {
        let field = volume.field(None).unwrap();
        let mut completed = way.scene(&scene).complete(&field.facts).unwrap();
        let plan = field.plan(&mut completed).unwrap();
        let whole = bits(&field.render(&plan, &Silent).unwrap().image);
        let mut given_up = 0;
        for most in 0_u64.. {
            match field.render(&plan, &Patience::of(most)) {
                Err(error) => {
                    assert!(error.is_interrupted(), "{way}, {most}: {error}");
                    assert_eq!(error.to_string(), "interrupted; there is no picture");
                    given_up += 1;
                }
                Ok(rendered) => {
                    assert_eq!(bits(&rendered.image), whole, "{way}, {most}");
                    break;
                }
            }
            assert_eq!(bits(&field.render(&plan, &Silent).unwrap().image), whole, "{way} after {most}");
        }
        // Tiles of 16 and 32 pixels, and the steps before; the device is asked between parts and blocks alone.
        let least = match way {
            Way::Reference => 15,
            Way::Cpu => 6,
            Way::Compute | Way::Triangles => 3,
        };
        assert!(given_up >= least, "{way} was asked {given_up} times");
    }
}

#[test]
fn only_giving_up_is_called_an_interruption() {
    let volume = Volume::from_dataset(rings_sample(2), "rings").unwrap();
    assert!(!volume.field(Some("no such array")).unwrap_err().is_interrupted());
}

#[test]
fn memory_that_is_not_there_is_an_error_before_the_work() {
    let volume = Volume::from_dataset(rings_sample(2), "rings").unwrap();
    let field = volume.field(None).unwrap();
    let scene = SceneFile::of_mesh(tetrascope::SAMPLE);
    for way in Way::CPU {
        let plan = field.plan(&mut way.scene(&scene).complete(&field.facts).unwrap()).unwrap();
        field.check_memory(&plan, &[]).unwrap();
        let error = field.check_memory(&plan, &[("files", 1 << 62)]).unwrap_err();
        assert!(matches!(&error, Error::Memory(memory) if memory.needed > 1 << 62), "{error:?}");
        let text = error.to_string();
        assert!(text.contains("e9 GiB of memory are needed") && text.contains("a smaller picture"), "{text}");
    }
}
