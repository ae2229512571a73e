//! What the command line takes and refuses.

use super::*;

#[test]
fn the_commands_are_consistent() {
    use clap::CommandFactory;
    Cli::command().debug_assert();
}

#[test]
fn control_points() {
    let Points(color) = color_points("0: 0,0.5,1 ;-1e3:1,1,1;").unwrap();
    assert_eq!(color, [[0.0, 0.0, 0.5, 1.0], [-1000.0, 1.0, 1.0, 1.0]]);
    assert_eq!(extinction_points("2:3").unwrap().0, [[2.0, 3.0]]);
    for wrong in ["", ";", "1", "1:2,3", "a:1", "1:nan", "1:2:3"] {
        assert!(extinction_points(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn fractions() {
    for (text, value) in [("1/255", 1.0 / 255.0), ("0", 0.0), ("1e-3", 1e-3), (" 3 / 4 ", 0.75), ("0/5", 0.0)] {
        assert_eq!(fraction(text), Ok(value), "{text}");
    }
    for wrong in ["", "/", "1/", "/2", "1/0", "0/0", "-1", "1/-2", "nan", "inf", "1/2/3", "a", "1 2"] {
        assert!(fraction(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn sizes() {
    assert_eq!(size("512"), Ok((512, 512)));
    assert_eq!(size("640x480"), Ok((640, 480)));
    for wrong in ["", "x", "640x", "-5", "1.5", "640x480x3"] {
        assert!(size(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn isosurfaces() {
    let plain = isosurface("-0.5").unwrap();
    assert_eq!(plain, IsosurfaceSection::new(-0.5, [0.9, 0.9, 0.9]));
    assert_eq!((plain.opacity, plain.shading), (1.0, Shading::None));
    assert_eq!(isosurface("2: 1,0.5,0").unwrap(), IsosurfaceSection::new(2.0, [1.0, 0.5, 0.0]));
    let glass = isosurface("2:1,0.5,0,0.25").unwrap();
    assert_eq!((glass.color, glass.opacity, glass.back_color), ([1.0, 0.5, 0.0], 0.25, None));
    for wrong in ["", "a", "nan", "1:", "1:1", "1:1,2", "1:1,2,3,4,5", "1:1,2,x", "1:1:1", "1,2"] {
        assert!(isosurface(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn negative_numbers_are_values() {
    let negative = ["--eye", "-1,-2,3", "--extinction", "-1:0;1:2", "--isosurface", "-1:1,1,1"];
    let cli = Cli::try_parse_from([&["tetrascope", "render", "a.vtu"], &negative[..]].concat());
    let Some(Command::Render(args)) = cli.unwrap().command else { panic!("not render") };
    assert_eq!(args.scene.look.camera.eye, Some([-1.0, -2.0, 3.0]));
    assert_eq!(args.scene.look.extinction, Some(Points(vec![[-1.0, 0.0], [1.0, 2.0]])));
    assert_eq!(args.scene.look.isosurface[0].value, -1.0);
}

#[test]
fn opacities_and_ranges() {
    assert_eq!(opacity("sigmoid_5"), Ok(OpacityName::Name("sigmoid_5".to_owned())));
    assert_eq!(opacity("0, 0.5,1"), Ok(OpacityName::Values(vec![0.0, 0.5, 1.0])));
    assert_eq!(opacity("-1:0; 2:0.5"), Ok(OpacityName::Points(vec![[-1.0, 0.0], [2.0, 0.5]])));
    assert!(opacity("0,a").is_err() && opacity("1:2:3").is_err());
    assert_eq!(range("-1,2.5"), Ok([-1.0, 2.5]));
    assert!(range("2,1").is_err() && range("1").is_err() && range("nan,1").is_err());
}
