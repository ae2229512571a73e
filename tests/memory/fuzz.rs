//! Some hundred files of each target: the same in every run.

use tetrascope_tests::fuzz::{Judge, Target, input, is_sound};

use crate::{allocated, alone};

/// Files of each target.
const FILES: u64 = 320;

#[test]
fn files_of_chance_are_read_or_refused() {
    let _alone = alone();
    let judge = Judge::new(allocated).unwrap();
    let mut failures = Vec::new();
    for target in Target::ALL {
        let (mut read, mut drawn, mut most) = (0, 0, 0.0_f64);
        for number in 0..FILES {
            let file = input(target, 1, number);
            match judge.judge(target, &file) {
                Ok(verdict) => {
                    if is_sound(number) && !verdict.is_read {
                        failures.push(format!("{target} {number}: a sound file is refused"));
                    }
                    read += u64::from(verdict.is_read);
                    drawn += u64::from(verdict.is_drawn);
                    most = most.max(verdict.allocated as f64 / (file.len().max(1)) as f64);
                }
                Err(problem) => failures.push(format!("{target} {number}: {problem}")),
            }
        }
        println!("{target}: {FILES} files, {read} read, {drawn} drawn, at most {most:.0} bytes allocated a byte");
        if read == FILES || read == 0 {
            failures.push(format!("{target}: {read} of {FILES} are read: the damage does not reach it"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
