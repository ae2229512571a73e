//! `cargo xtask hard-cases`: draws every hard case, holds it to its limits, and writes pictures and figures of `docs/hard-cases.md`.

use std::fs;

use tetrascope::{make_folder, write_png};
use tetrascope_tests::hard::document::{CaseFigures, MARKS, sections};
use tetrascope_tests::hard::{HardCase, all, judge};
use tetrascope_tests::ways::Way;

use crate::Failure;

const DOCUMENT: &str = "docs/hard-cases.md";
const PICTURES: &str = "docs/images/hard";
/// Times as many pixels along each side as a test has.
const LARGER: u32 = 4;
/// Behind the pictures: dark, so that dark colors show too.
const BACKGROUND: [f32; 3] = [0.03; 3];

#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Only the case of this name: its figures are printed, and only its picture is written
    #[arg(long)]
    case: Option<String>,
    /// Only the pictures
    #[arg(long)]
    pictures: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let cases: Vec<HardCase> =
        all().into_iter().filter(|case| args.case.as_ref().is_none_or(|name| name == case.name)).collect();
    if cases.is_empty() {
        return Err(format!("no hard case is named {:?}", args.case.as_deref().unwrap_or_default()).into());
    }
    let folder = crate::root().join(PICTURES);
    make_folder(&folder)?;
    for case in &cases {
        let Some(mut first) = (case.scenes)().into_iter().next() else { continue };
        first.scene.image.width *= LARGER;
        first.scene.image.height *= LARGER;
        let drawn = Way::Cpu.draw(&first.volume, &first.scene)?;
        write_png(&folder.join(format!("{}.png", case.name)), &drawn.image, BACKGROUND)?;
    }
    if args.pictures {
        return Ok(());
    }

    let ways = Way::here("hard cases");
    let (mut told, mut failures) = (Vec::new(), Vec::new());
    for case in &cases {
        let mut figures: Vec<CaseFigures> = ways.iter().map(|&way| CaseFigures::new(way)).collect();
        for hard in (case.scenes)() {
            for (figures, found) in figures.iter_mut().zip(judge(&hard, &ways)) {
                figures.take(&found, hard.is_judged(found.way));
                failures.extend(
                    found.failures.iter().map(|f| format!("{}, {}, {}: {f}", case.name, hard.place, found.way)),
                );
            }
        }
        // The reference is what the others are held against.
        figures.retain(|figures| figures.way != Way::Reference);
        let one = [(*case, figures)];
        println!("{}", sections(&one).trim_end().lines().last().unwrap_or_default());
        told.extend(one);
    }
    if !failures.is_empty() {
        return Err(failures.join("\n").into());
    }
    if args.case.is_some() || ways.len() < Way::ALL.len() {
        println!("{DOCUMENT} is left as it is: it has all cases, by all ways");
        return Ok(());
    }
    let path = crate::root().join(DOCUMENT);
    let old = fs::read_to_string(&path)?;
    let [begin, end] = MARKS;
    let (Some((before, _)), Some((_, after))) = (old.split_once(begin), old.split_once(end)) else {
        return Err(format!("{DOCUMENT} lacks {begin} or {end}, between which the cases stand").into());
    };
    fs::write(&path, format!("{before}{begin}\n\n{}{end}{after}", sections(&told)))?;
    println!("{DOCUMENT} is written");
    Ok(())
}
