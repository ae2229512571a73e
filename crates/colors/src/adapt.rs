//! Few control points for many pieces: straight lines in what a renderer mixes, judged in what an eye or a user sees.

/// Half of one of the 255 steps of an 8-bit channel.
pub const HALF_GRAY_LEVEL: f64 = 0.5 / 255.0;

/// What smaller errors count as; there are then some ten thousand points to a map.
const SMALLEST_ERROR: f64 = 1e-5;

/// The share of the error that goes to what lies between samples. The rest is for the lines.
const BETWEEN_SAMPLES: f64 = 0.125;

/// Halvings of a piece at most: a kink of any strength is then closer to a sample than 2⁻²⁰ of the piece.
const DEEPEST: u32 = 20;

/// Pieces up to which no line goes across the end of one: points that somebody set are then kept as they are. Many pieces are a table,
/// whose
/// entries mean nothing by themselves; they lie closer together than their mixtures bend, whereas few may have kinks inside, which a look
/// at
/// three places could miss.
const FEW: usize = 64;

/// Samples after which lines end at the next end of a piece, so that they need no memory to speak of.
const LONGEST: usize = 1 << 14;

/// Differences below this between the end of a piece and the beginning of the next are rounding, not a step: conversion to Lab and back is
/// off
/// by as much as 4e-4, but both sides are then off alike.
const STEP: f64 = 1e-9;

/// A stretch over which a function has no step.
pub(crate) struct Piece<'a, const N: usize> {
    pub(crate) start: f64,
    /// Above `start`.
    pub(crate) end: f64,
    /// The encoded values at a share of the stretch, 0 and 1 included.
    pub(crate) at: Box<dyn Fn(f64) -> [f64; N] + 'a>,
}

/// Between the values that are judged, channel by channel, and those that are mixed; monotone, and each undoes the other.
#[derive(Clone, Copy)]
pub(crate) struct Encoding {
    pub(crate) decode: fn(f64) -> f64,
    pub(crate) encode: fn(f64) -> f64,
}

#[derive(Clone, Copy)]
struct Sample<const N: usize> {
    x: f64,
    encoded: [f64; N],
    mixed: [f64; N],
}

/// Points `(x, decoded values)`, ascending, of which the straight lines, encoded, are within `error` of the pieces. Two points at one place
/// are
/// a step.
pub(crate) fn control_points<const N: usize>(
    pieces: &[Piece<'_, N>],
    encoding: Encoding,
    error: f64,
) -> Vec<(f64, [f64; N])> {
    let error = if error > SMALLEST_ERROR { error } else { SMALLEST_ERROR };
    let (between, along) = (error * BETWEEN_SAMPLES, error * (1.0 - BETWEEN_SAMPLES));
    let few = pieces.len() <= FEW;
    let least_depth = if few { 4 } else { 1 };
    let mut points = Vec::new();
    let mut run: Vec<Sample<N>> = Vec::new();
    for piece in pieces {
        let sample = |share: f64| {
            let mixed = (piece.at)(share).map(encoding.decode);
            let x = if share >= 1.0 { piece.end } else { piece.start + share * (piece.end - piece.start) };
            // What cannot be decoded to the full, such as full opacity, is judged as far as it can: else no line would do.
            Sample { x, encoded: mixed.map(encoding.encode), mixed }
        };
        let first = sample(0.0);
        let continues = run.last().is_some_and(|last| apart(last.encoded, first.encoded) <= STEP);
        if few || !continues {
            join(&run, encoding, along, &mut points);
            run.clear();
            run.push(first);
        }
        halve(&sample, [(0.0, first), (1.0, sample(1.0))], 0, least_depth, (encoding, between), &mut run);
        if few && continues {
            // Where the piece before has ended, there is a point already.
            points.pop();
        }
        if run.len() > LONGEST {
            // The next run begins with the point at which this one ends.
            join(&run, encoding, along, &mut points);
            run.drain(..run.len() - 1);
            points.pop();
        }
    }
    join(&run, encoding, along, &mut points);
    points
}

/// Samples after the first of two, up to the second, so close that lines between them are near enough.
fn halve<const N: usize>(
    sample: &dyn Fn(f64) -> Sample<N>,
    [from, to]: [(f64, Sample<N>); 2],
    depth: u32,
    least_depth: u32,
    judge: (Encoding, f64),
    run: &mut Vec<Sample<N>>,
) {
    let at = |share: f64| from.0 + share * (to.0 - from.0);
    let middle = sample(at(0.5));
    let (encoding, error) = judge;
    let near = |share: f64, sample: &Sample<N>| deviation([&from.1, &to.1], share, sample, encoding) <= error;
    if depth >= least_depth && near(0.5, &middle) || depth >= DEEPEST {
        let quarters = [sample(at(0.25)), middle, sample(at(0.75))];
        if depth >= DEEPEST || near(0.25, &quarters[0]) && near(0.75, &quarters[2]) {
            // The quarters too: a longer line that is near both ends need not be near between them where the encoding bends.
            run.extend(quarters);
            run.push(to.1);
            return;
        }
    }
    let middle = (at(0.5), middle);
    halve(sample, [from, middle], depth + 1, least_depth, judge, run);
    halve(sample, [middle, to], depth + 1, least_depth, judge, run);
}

/// From each point as far as a straight line goes.
fn join<const N: usize>(run: &[Sample<N>], encoding: Encoding, error: f64, points: &mut Vec<(f64, [f64; N])>) {
    let Some(first) = run.first() else { return };
    points.push((first.x, first.mixed));
    let reaches = |from: usize, to: usize| {
        let (Some(a), Some(b), Some(between)) = (run.get(from), run.get(to), run.get(from + 1..to)) else {
            return false;
        };
        let width = b.x - a.x;
        let share = |sample: &Sample<N>| if width > 0.0 { (sample.x - a.x) / width } else { 0.0 };
        between.iter().all(|sample| deviation([a, b], share(sample), sample, encoding) <= error)
    };
    let mut from = 0;
    while from + 1 < run.len() {
        // Ever longer leaps, then halves of the last: as much work as the line is long, but for a logarithm.
        let (mut near, mut leap) = (from + 1, 2);
        while reaches(from, from + leap) {
            near = from + leap;
            leap *= 2;
        }
        let mut far = (from + leap).min(run.len());
        while far > near + 1 {
            let middle = near.midpoint(far);
            if reaches(from, middle) { near = middle } else { far = middle }
        }
        from = near;
        if let Some(sample) = run.get(from) {
            points.push((sample.x, sample.mixed));
        }
    }
}

/// How far the line between two samples, encoded, is at a share of it from a third one.
fn deviation<const N: usize>([from, to]: [&Sample<N>; 2], share: f64, sample: &Sample<N>, encoding: Encoding) -> f64 {
    let line = core::array::from_fn(|i| (encoding.encode)((1.0 - share) * from.mixed[i] + share * to.mixed[i]));
    apart(line, sample.encoded)
}

fn apart<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.into_iter().zip(b).fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()))
}
