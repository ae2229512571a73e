//! The data sections of a file: what each holds, and which belong to the chosen time step.

use std::collections::{BTreeMap, HashMap};

use super::numbers::Numbers;
use super::sections::Section;
use crate::{IoError, Source};

/// What the values of a section belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Owner {
    /// One tuple a node.
    Nodes,
    /// One tuple an element.
    Elements,
    /// One tuple for each node of each element.
    ElementNodes,
}

impl Owner {
    /// Of a section by its name.
    pub(super) fn of(name: &[u8]) -> Option<Self> {
        match name {
            b"NodeData" => Some(Self::Nodes),
            b"ElementData" => Some(Self::Elements),
            b"ElementNodeData" => Some(Self::ElementNodes),
            _ => None,
        }
    }
}

/// A data section whose values are not read yet.
pub(super) struct View<'a> {
    pub(super) section: Section<'a>,
    /// Where in the section's body the values begin.
    pub(super) values_at: usize,
    pub(super) owner: Owner,
    pub(super) name: String,
    step: i64,
    time: f64,
    pub(super) components: usize,
    /// Tuples that the section declares.
    pub(super) count: u64,
}

/// What was chosen.
pub(super) struct Chosen {
    /// As in [`Loaded::times`](crate::Loaded::times).
    pub(super) times: Vec<f64>,
    /// As in [`Loaded::step`](crate::Loaded::step).
    pub(super) step: usize,
    /// Places in the list of views.
    pub(super) views: Vec<usize>,
}

/// More components than a tensor has are those of no view, and would let few bytes stand for many.
const MOST_COMPONENTS: usize = 9;

/// Reads the tags of a data section: texts, of which the first is the name; reals, of which the first is the time; whole numbers, which
/// are the step, the number of components and that of tuples.
///
/// # Errors
/// [`IoError::Invalid`] where they are damaged.
pub(super) fn view<'a>(source: &'a Source, section: Section<'a>, owner: Owner) -> Result<View<'a>, IoError> {
    let mut numbers = Numbers::new(source, section, 0);
    let numbers = &mut numbers;
    let texts: u64 = numbers.word("the number of texts")?;
    numbers.end_line();
    let mut name = String::new();
    for text in 0..texts {
        if numbers.rest().is_empty() {
            return Err(numbers.invalid(format!("the section ends after {text} of {texts} texts")));
        }
        let line = numbers.line();
        if text == 0 {
            name = unquoted(&line).to_owned();
        }
    }
    let mut time = 0.0;
    for real in 0..numbers.word::<u64>("the number of real tags")? {
        let value = numbers.real_word("a real tag")?;
        if real == 0 {
            time = value;
        }
    }
    let mut tags = [0_i64; 3];
    let count: u64 = numbers.word("the number of integer tags")?;
    if count < 3 {
        return Err(numbers.invalid(format!("{count} integer tags, where step, components and tuples belong")));
    }
    for tag in 0..count {
        let value = numbers.word("an integer tag")?;
        if let Some(slot) = usize::try_from(tag).ok().and_then(|tag| tags.get_mut(tag)) {
            *slot = value;
        }
    }
    numbers.end_line();
    let [step, components, tuples] = tags;
    match (usize::try_from(components), u64::try_from(tuples)) {
        (Ok(components @ 1..=MOST_COMPONENTS), Ok(count)) => {
            Ok(View { section, values_at: numbers.position, owner, name, step, time, components, count })
        }
        _ => Err(numbers.invalid(format!(
            "`{name}` has {tuples} tuples of {components} components, where 1 to {MOST_COMPONENTS} are allowed"
        ))),
    }
}

/// Text between quotation marks, or all of it where there are none.
pub(super) fn unquoted(line: &str) -> &str {
    line.split_once('"').map_or(line, |(_, rest)| rest.rsplit_once('"').map_or(rest, |(name, _)| name))
}

/// What tells one step of a view from another: its number, or its time as an ordered integer.
type Key = i64;

/// The views of the step that the user means. A view of a single step belongs to all.
///
/// Steps are told apart by their times, or by their numbers where a view has one time twice.
///
/// # Errors
/// [`IoError::Invalid`] where there is no such step.
pub(super) fn choose(source: &Source, views: &[View<'_>], warnings: &mut Vec<String>) -> Result<Chosen, IoError> {
    let mut step_at = HashMap::new();
    let by_number = views.iter().any(|view| {
        let first = *step_at.entry((view.owner, &view.name, view.time.to_bits())).or_insert(view.step);
        first != view.step
    });
    let key_of = |view: &View<'_>| if by_number { view.step } else { ordered(view.time) };

    // All keys of each view, and of all that have several.
    let mut keys: HashMap<(Owner, &str), BTreeMap<Key, f64>> = HashMap::new();
    for view in views {
        keys.entry((view.owner, &view.name)).or_default().entry(key_of(view)).or_insert(view.time);
    }
    let mut steps: BTreeMap<Key, f64> = BTreeMap::new();
    for view in views {
        if keys.get(&(view.owner, view.name.as_str())).is_some_and(|own| own.len() > 1) {
            steps.entry(key_of(view)).or_insert(view.time);
        }
    }
    if steps.is_empty() {
        // The one time that all have, if they do.
        let mut times: Vec<f64> = views.iter().map(|view| view.time).collect();
        times.dedup_by_key(|time| time.to_bits());
        let times = if times.len() == 1 { times } else { Vec::new() };
        let step = source.step(&times)?;
        return Ok(Chosen { times, step, views: (0..views.len()).collect() });
    }
    let times: Vec<f64> = steps.values().copied().collect();
    let step = source.step(&times)?;
    let wanted = steps.keys().nth(step).copied();
    let mut chosen = Vec::new();
    for (place, view) in views.iter().enumerate() {
        let Some(own) = keys.get_mut(&(view.owner, view.name.as_str())) else { continue };
        if own.len() == 1 || wanted == Some(key_of(view)) {
            chosen.push(place);
        } else if wanted.is_some_and(|wanted| !own.contains_key(&wanted)) && own.len() > 1 {
            warnings.push(format!("`{}` has no values at step {step}, and was left out", view.name));
            // Once is enough: the step at hand now counts as there.
            own.extend(wanted.map(|wanted| (wanted, 0.0)));
        }
    }
    Ok(Chosen { times, step, views: chosen })
}

/// An integer that is ordered as the numbers are, NaN included.
fn ordered(time: f64) -> Key {
    let bits = time.to_bits().cast_signed();
    if bits < 0 { bits ^ i64::MAX } else { bits }
}
