//! The GPU through the facade, where there is one.

use tetrascope::{Backend, Choice, SceneFile, Silent, Volume, render_volume};
use tetrascope_tests::gpu;

/// Software that poses as a card is taken by its name alone.
#[test]
fn the_device_of_tests_is_taken_by_name_only_if_it_is_software() {
    let Some(device) = gpu::gpu("the_device_of_tests_is_taken_by_name_only_if_it_is_software") else { return };
    let description = device.description();
    assert!(description.is_capable, "{description:?}");
    if description.kind != "cpu" || tetrascope::adapter_of_auto(&tetrascope::adapters()).is_some() {
        return;
    }
    let mut scene = SceneFile::of_mesh(tetrascope::SAMPLE);
    (scene.image.width, scene.image.height) = (16, 16);
    scene.quality.backend = Choice::Auto;
    let picture = render_volume(&Volume::sample().unwrap(), &scene, &Silent).unwrap();
    assert_eq!((picture.plan.backend, picture.warnings.as_slice()), (Backend::Cpu, &[][..]));
    let said = picture.plan.decisions.iter().find(|decision| decision.subject == "backend").unwrap();
    assert!(said.reason.contains("software"), "{said}");
}
