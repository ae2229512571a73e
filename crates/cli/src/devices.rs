//! `tetrascope devices`: which graphics cards there are, and which one is taken.

use serde_json::{Value, json};
use tetrascope::{AdapterDescription, adapter_of_auto, adapters};

use crate::Failure;
use crate::args::DevicesArgs;
use crate::report::{line, object};

pub(crate) fn run(args: &DevicesArgs) -> Result<(), Failure> {
    let found = adapters();
    let taken = adapter_of_auto(&found);
    if args.json {
        let list: Vec<Value> = found.iter().enumerate().map(|(number, adapter)| as_json(number, adapter)).collect();
        object(&json!({ "adapters": list, "auto": taken }));
    } else {
        found.iter().enumerate().flat_map(|(number, adapter)| lines_of(number, adapter)).for_each(|text| line(&text));
        line(&conclusion(&found, taken));
    }
    Ok(())
}

fn lines_of(number: usize, adapter: &AdapterDescription) -> [String; 3] {
    let blending = if adapter.blends_32_bits { "blends 16 and 32 bits" } else { "blends 16 bits" };
    let clock = if adapter.has_timestamps { "times of stages" } else { "no times of stages" };
    let use_of = if adapter.is_capable {
        format!("{blending}, {clock}")
    } else {
        "cannot draw: it lacks what every browser gives".to_owned()
    };
    [
        format!("{number:<4}{} ({}, {})", adapter.name, kind_of(adapter), adapter.backend),
        format!("    driver {}", if adapter.driver.is_empty() { "without a name" } else { &adapter.driver }),
        format!("    {use_of}, up to {} MiB a binding", adapter.largest_binding >> 20),
    ]
}

fn kind_of(adapter: &AdapterDescription) -> &'static str {
    match adapter.kind {
        "cpu" => "software",
        kind => kind,
    }
}

fn as_json(number: usize, adapter: &AdapterDescription) -> Value {
    json!({ "number": number, "name": adapter.name, "kind": adapter.kind, "driver": adapter.driver, "api": adapter.backend,
        "can_draw": adapter.is_capable, "blends_32_bits": adapter.blends_32_bits, "timestamps": adapter.has_timestamps,
        "largest_binding": adapter.largest_binding, "largest_buffer": adapter.largest_buffer })
}

/// What `--backend auto` takes, and what to do where that is no graphics card.
fn conclusion(found: &[AdapterDescription], taken: Option<usize>) -> String {
    if let Some(number) = taken {
        return format!("--backend auto draws with number {number}, \"{}\"", found[number].name);
    }
    let install = "install your graphics card's driver of Vulkan, or on Debian mesa-vulkan-drivers, which has one in software too";
    if found.iter().any(|adapter| adapter.is_capable) {
        return "--backend auto draws with the CPU: no graphics card answers (if there is one, install its driver of Vulkan), and software for processors is taken only by \
                --backend gpu or --adapter"
            .to_owned();
    }
    match found {
        [] => format!("no adapter was found, and --backend auto draws with the CPU; {install}"),
        _ => format!("none of these can draw, and --backend auto draws with the CPU; {install}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn adapter(kind: &'static str, is_capable: bool) -> AdapterDescription {
        AdapterDescription {
            name: "llvmpipe (LLVM 19)".to_owned(),
            driver: "Mesa 25".to_owned(),
            backend: "vulkan".to_owned(),
            kind,
            is_capable,
            blends_32_bits: true,
            has_timestamps: false,
            largest_binding: 1 << 27,
            largest_buffer: 1 << 28,
        }
    }

    #[test]
    fn an_adapter_has_three_lines() {
        let [name, driver, abilities] = lines_of(2, &adapter("cpu", true));
        assert_eq!(name, "2   llvmpipe (LLVM 19) (software, vulkan)");
        assert_eq!(driver, "    driver Mesa 25");
        assert_eq!(abilities, "    blends 16 and 32 bits, no times of stages, up to 128 MiB a binding");
        let [_, driver, abilities] =
            lines_of(0, &AdapterDescription { driver: String::new(), ..adapter("other", false) });
        assert_eq!(driver, "    driver without a name");
        assert!(abilities.contains("cannot draw"), "{abilities}");
    }

    #[test]
    fn the_last_line_says_what_is_taken_or_what_to_install() {
        let card = [adapter("discrete", true)];
        assert!(conclusion(&card, Some(0)).starts_with("--backend auto draws with number 0, \"llvmpipe"));
        let software = conclusion(&[adapter("cpu", true)], None);
        assert!(software.contains("the CPU") && software.contains("--backend gpu"), "{software}");
        for (found, start) in
            [(&[][..], "no adapter was found"), (&[adapter("discrete", false)], "none of these can draw")]
        {
            let text = conclusion(found, None);
            assert!(
                text.starts_with(start) && text.contains("install") && text.contains("mesa-vulkan-drivers"),
                "{text}"
            );
        }
    }
}
