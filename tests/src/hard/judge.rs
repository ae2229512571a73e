//! Draws a hard scene in every way and holds the pictures against what is known of it.

use glam::DVec3;
use tetrascope::{LinearImage, OpticalModel, SceneFile, View};

use super::{HardScene, Limits, Truth};
use crate::chords::chords;
use crate::ways::{Drawn, Way};

/// What light may differ by in any channel: on the CPU, and on a GPU.
pub const LIGHT_LIMITS: Limits = Limits::of_two(1e-5, 2e-5);
/// What chords may differ by, relative to themselves, or to a tenth of the longest in the picture where they are shorter: at a silhouette a chord
/// goes to 0, and its planes are known to f32 relative to the cell.
///
/// On the CPU, and on a GPU, which has no f64 for planes that are steep.
pub const CHORD_LIMITS: Limits = Limits::of_two(1e-5, 1e-4);
/// What opacity may differ by from the plane of its neighbors: on the CPU, and on a GPU.
pub const CRACK_LIMITS: Limits = Limits::of_two(1e-5, 2e-5);
/// Share of the longest chord below which errors are relative to that.
const SHORT: f64 = 0.1;
/// Optical depth of the longest chord in the picture that is looked at for cracks: opacities are neither 0 nor 1.
const DEPTH: f64 = 2.0;
/// Words of the one refusal that is right in every scene, of [`Way::Triangles`] alone: by the scene file, and by the device.
pub const CANNOT_SORT: [&str; 2] =
    ["is sorted in the pixels, which triangles on the back end \"gpu\" cannot", "triangles cannot sort pixel by pixel"];

/// What one way made of one scene.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Who drew it.
    pub way: Way,
    /// Largest relative error of a chord; `None` where chords are not known.
    pub chord: Option<f64>,
    /// Largest distance in opacity, with one extinction everywhere, from the plane of a pixel's neighbors, over what the true plane's curvature is.
    pub crack: Option<f64>,
    /// Largest difference of the scene's own picture from the truth, in any channel.
    pub light: f64,
    /// Why it does not draw the scene, in the words that the user reads.
    pub refused: Option<String>,
    /// What is beyond its limit, one sentence each; empty if all is well.
    pub failures: Vec<String>,
}

/// Draws the scene in these ways.
///
/// Each way draws the scene as it is, and where chords are known a picture of one extinction. Every number must be finite, colors not negative,
/// opacities from 0 to 1; on the CPU one and three threads must give the same bits.
pub fn judge(hard: &HardScene, ways: &[Way]) -> Vec<Finding> {
    let exact = Exact::of(hard);
    ways.iter().map(|&way| finding(hard, way, &exact)).collect()
}

/// What the pictures are held against.
struct Exact {
    /// One chord a pixel, `None` at an edge.
    chords: Option<Vec<Option<f64>>>,
    /// The scene's own picture.
    light: Vec<Option<[f64; 4]>>,
    width: usize,
}

impl Exact {
    fn of(hard: &HardScene) -> Self {
        let view = view_of(hard);
        let rays = || {
            (0..view.height)
                .flat_map(|y| (0..view.width).map(move |x| (x, y)))
                .map(|(x, y)| view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5))
        };
        let by_reference = || {
            let image = Way::Reference.draw(&hard.volume, &hard.scene).expect("the reference draws every scene").image;
            image.pixels().iter().map(|p| Some(p.map(f64::from))).collect()
        };
        let (chords, light) = match &hard.truth {
            Truth::Outline(triangles) => (Some(chords_near_the_origin(hard, triangles)), by_reference()),
            Truth::Reference => (None, by_reference()),
            Truth::Light(light) => (None, rays().map(|ray| light(&ray)).collect()),
        };
        Self { chords, light, width: view.width as usize }
    }
}

fn view_of(hard: &HardScene) -> View {
    view_from(hard, DVec3::ZERO)
}

/// The view with the camera moved.
fn view_from(hard: &HardScene, origin: DVec3) -> View {
    let field = hard.volume.field(hard.scene.mesh.field.as_deref()).expect("hard scenes have a field");
    let mut scene = hard.scene.complete(&field.facts).expect("hard scenes are complete").scene;
    scene.camera.eye -= origin;
    scene.camera.target -= origin;
    View::new(&scene.camera, scene.width, scene.height).expect("hard scenes have a good camera")
}

/// The true chords, found where numbers are small: parallel rays begin beside the eye, and far away that place has no digits for it.
fn chords_near_the_origin(hard: &HardScene, triangles: &[[DVec3; 3]]) -> Vec<Option<f64>> {
    let origin = hard.volume.decomposition.mesh.frame().origin;
    let near: Vec<[DVec3; 3]> = triangles.iter().map(|triangle| triangle.map(|p| p - origin)).collect();
    chords(&near, &view_from(hard, origin))
}

fn finding(hard: &HardScene, way: Way, exact: &Exact) -> Finding {
    let mut found = Finding { way, chord: None, crack: None, light: 0.0, refused: None, failures: Vec::new() };
    let drawn = match draw(hard, &hard.scene, &mut found) {
        Ok(drawn) => drawn,
        Err(words) => {
            if !may_refuse(hard, way, &words) {
                found.failures.push(format!("it is refused: {words}"));
            }
            found.refused = Some(words);
            return found;
        }
    };
    check_words(hard, &drawn, &mut found);
    check_threads(hard, &drawn.image, &mut found);
    let within = hard.light_within(way);
    let mut worst = (0.0, 0);
    for (pixel, (drawn, known)) in drawn.image.pixels().iter().zip(&exact.light).enumerate() {
        let Some(known) = known else { continue };
        let difference = drawn
            .iter()
            .zip(known)
            .map(|(d, k)| (f64::from(*d) - k).abs())
            .fold(0.0_f64, |a, b| if b > a { b } else { a });
        if difference > worst.0 {
            worst = (difference, pixel);
        }
    }
    found.light = worst.0;
    if worst.0 > within {
        let [x, y] = [worst.1 % exact.width, worst.1 / exact.width];
        found.failures.push(format!("light is off by {:.2e} of {within:.0e} at ({x}, {y})", worst.0));
    }
    if let Some(chords) = &exact.chords {
        check_chords(hard, chords, exact.width, &mut found);
    }
    found
}

/// Whether a way may refuse a scene in these words. A device that is lost or a program that does not compile is a failure.
fn may_refuse(hard: &HardScene, way: Way, words: &str) -> bool {
    (way == Way::Triangles && CANNOT_SORT.iter().any(|known| words.contains(known)))
        || (way.needs_gpu() && hard.refused.is_some_and(|expected| words.contains(expected)))
}

/// The picture, of which is noted what is unsound, or the words in which it is refused.
fn draw(hard: &HardScene, scene: &SceneFile, found: &mut Finding) -> Result<Drawn, String> {
    let drawn = found.way.draw(&hard.volume, scene).map_err(|error| error.to_string())?;
    let unsound = drawn.image.pixels().iter().filter(|p| !is_sound(p)).count();
    if unsound > 0 {
        found.failures.push(format!("{unsound} pixels are not finite, negative or of an opacity beyond 1"));
    }
    Ok(drawn)
}

/// Colors are finite and not negative, opacities from 0 to 1.
pub fn is_sound(pixel: &[f32; 4]) -> bool {
    pixel.iter().all(|c| c.is_finite() && *c >= 0.0) && pixel[3] <= 1.0
}

fn check_words(hard: &HardScene, drawn: &Drawn, found: &mut Finding) {
    let beyond = hard.beyond_of(found.way).map(|beyond| beyond.words);
    for words in hard.says.into_iter().chain(beyond) {
        if !drawn.warnings.iter().any(|warning| warning.contains(words)) {
            found.failures.push(format!("no warning has the words \"{words}\": {:?}", drawn.warnings));
        }
    }
}

fn check_threads(hard: &HardScene, image: &LinearImage, found: &mut Finding) {
    if found.way.needs_gpu() {
        return;
    }
    for threads in [1, 3] {
        match found.way.draw_on(&hard.volume, &hard.scene, threads) {
            Ok(other) if other == *image => {}
            Ok(_) => found.failures.push(format!("{threads} threads give other bits")),
            Err(error) => found.failures.push(format!("{threads} threads: {error}")),
        }
    }
}

/// One extinction everywhere: each pixel's color tells its chord, to more digits than its opacity where that is near 1.
fn check_chords(hard: &HardScene, chords: &[Option<f64>], width: usize, found: &mut Finding) {
    let longest = chords.iter().flatten().copied().fold(0.0, f64::max);
    if longest == 0.0 {
        found.failures.push("no ray meets the mesh".to_owned());
        return;
    }
    let extinction = DEPTH / longest;
    let mut scene = hard.scene.clone();
    scene.optics.model = OpticalModel::DensityEmitter;
    scene.transfer.color = Some(vec![[0.0, 1.0, 1.0, 1.0]]);
    scene.transfer.extinction = Some(vec![[0.0, extinction]]);
    (scene.isosurface, scene.light) = (Vec::new(), None);
    let drawn = match draw(hard, &scene, found) {
        Ok(drawn) => drawn,
        Err(words) => {
            // The scene itself was drawn, in the same order.
            found.failures.push(format!("of one extinction it is refused: {words}"));
            return;
        }
    };
    let pixels = drawn.image.pixels();

    let mut chord_error = (0.0, 0);
    for (pixel, chord) in chords.iter().enumerate() {
        let Some(chord) = chord else { continue };
        let drawn = -(-f64::from(pixels[pixel][0])).ln_1p() / extinction;
        let error = (drawn - chord).abs() / chord.max(SHORT * longest);
        if error.is_nan() || error > chord_error.0 {
            chord_error = (error, pixel);
        }
    }
    found.chord = Some(chord_error.0);
    let [chord_limit, crack_limit] = [hard.chord_within, hard.crack_within].map(|limits| limits.of(found.way));
    if chord_error.0.is_nan() || (chord_error.0 > chord_limit && hard.is_judged(found.way)) {
        let [x, y] = [chord_error.1 % width, chord_error.1 / width];
        found.failures.push(format!("a chord is off by {:.2e} of itself at ({x}, {y})", chord_error.0));
    }

    // What is drawn less what is true is flat, whatever the shape.
    let residual = |pixel: usize| {
        let chord = chords[pixel].filter(|&chord| chord > 0.0)?;
        Some(f64::from(pixels[pixel][3]) + (-extinction * chord).exp_m1())
    };
    let mut crack = (0.0_f64, 0);
    for pixel in width..pixels.len().saturating_sub(width) {
        if pixel % width == 0 || pixel % width == width - 1 {
            continue;
        }
        for step in [1, width] {
            let Some(off) =
                (|| Some((residual(pixel)? - 0.5 * (residual(pixel - step)? + residual(pixel + step)?)).abs()))()
            else {
                continue;
            };
            if off > crack.0 {
                crack = (off, pixel);
            }
        }
    }
    found.crack = Some(crack.0);
    if crack.0 > crack_limit && hard.is_judged(found.way) {
        let [x, y] = [crack.1 % width, crack.1 / width];
        found.failures.push(format!("opacity is {:.2e} from its neighbors' plane at ({x}, {y})", crack.0));
    }
}
