//! Reads hostile files for `cargo xtask fuzz`, in a process of its own, whose allocator counts.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program speaks to its user")]

use std::alloc::System;
use std::process::ExitCode;

use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use tetrascope_tests::fuzz::{Judge, Target, input};

#[global_allocator]
static COUNTED: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Arguments: a target, and then either a seed, the first number and how many, or `--replay` and a file.
fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(problem) => {
            eprintln!("error: {problem}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<bool, Box<dyn std::error::Error>> {
    let judge = Judge::new(|| COUNTED.stats().bytes_allocated)?;
    let [target, rest @ ..] = arguments else { return Err("a target is missing".into()) };
    let target: Target = target.parse()?;
    if let [option, path] = rest
        && option == "--replay"
    {
        let file = std::fs::read(path)?;
        return Ok(match judge.judge(target, &file) {
            Ok(verdict) => {
                println!("{} bytes: {verdict:?}", file.len());
                true
            }
            Err(problem) => {
                println!("{} bytes: {problem}", file.len());
                false
            }
        });
    }
    let [seed, from, count] = rest else { return Err("a seed, a first number and a count are needed".into()) };
    let (seed, from, count): (u64, u64, u64) = (seed.parse()?, from.parse()?, count.parse()?);
    let (mut read, mut drawn) = (0, 0);
    for number in from..from + count {
        // Said before: whoever waits knows the file even if this process is gone.
        println!("at {number}");
        match judge.judge(target, &input(target, seed, number)) {
            Ok(verdict) => {
                read += u64::from(verdict.is_read);
                drawn += u64::from(verdict.is_drawn);
            }
            Err(problem) => {
                println!("{problem}");
                return Ok(false);
            }
        }
    }
    println!("counts {count} {read} {drawn}");
    Ok(true)
}
