//! Kernels that were built, by what they were built from.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use tetrascope_shaders::{Constant, Program, Slot};

use crate::kernel::Kernel;
use crate::{Gpu, GpuError};

/// What a variant of a program is made of: files in its slots, and constants.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Variant {
    pub(crate) slots: Vec<Slot<'static>>,
    pub(crate) constants: Vec<(&'static str, Constant)>,
}

impl Variant {
    /// The same with more slots.
    pub(crate) fn with_slots(&self, slots: &[Slot<'static>]) -> Self {
        let mut more = self.clone();
        more.slots.extend_from_slice(slots);
        more
    }

    /// The same with more constants.
    pub(crate) fn with_constants(&self, constants: &[(&'static str, Constant)]) -> Self {
        let mut more = self.clone();
        more.constants.extend_from_slice(constants);
        more
    }
}

impl Variant {
    /// A program in this variant, in words: what fills its slots, and the constants that are not off.
    pub(crate) fn describe(&self, file: &str) -> String {
        let parts = self.slots.iter().map(|(slot, file)| format!("{slot} {file}"));
        let constants = self.constants.iter().filter(|(_, value)| *value != Constant::Bool(false));
        let constants = constants.map(|(name, value)| match value {
            Constant::Bool(_) => (*name).to_owned(),
            Constant::F32(value) => format!("{name} {value}"),
            Constant::U32(value) => format!("{name} {value}"),
            Constant::I32(value) => format!("{name} {value}"),
        });
        let all: Vec<String> = parts.chain(constants).collect();
        format!("{file}: {}", all.join(", "))
    }
}

/// What a program and what it binds are, in words.
pub(crate) fn describe(file: &str, variant: &Variant, kernel: &Kernel) -> String {
    let bindings: Vec<&str> = kernel.bindings().iter().map(|binding| binding.name.as_str()).collect();
    format!("{}; binds {}", variant.describe(file), bindings.join(", "))
}

/// All kernels that were built so far. They are small, and building one takes longer than a frame.
#[derive(Debug, Default)]
pub(crate) struct Kernels {
    built: Mutex<HashMap<String, Arc<Kernel>>>,
}

impl Kernels {
    /// Forgets all.
    pub(crate) fn forget(&self) {
        self.built.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// How many were built.
    #[cfg(test)]
    pub(crate) fn count(&self) -> usize {
        self.built.lock().unwrap_or_else(PoisonError::into_inner).len()
    }

    /// An entry point of a program in a variant; built when first asked for.
    ///
    /// # Errors
    /// [`GpuError::Shader`] if the program cannot be composed.
    pub(crate) fn get(
        &self,
        gpu: &Gpu,
        file: &str,
        entry_point: &str,
        variant: &Variant,
    ) -> Result<Arc<Kernel>, GpuError> {
        let key = format!("{file} {entry_point} {variant:?}");
        let mut built = self.built.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(kernel) = built.get(&key) {
            return Ok(Arc::clone(kernel));
        }
        let program = Program::compose(file, &variant.slots, &variant.constants)?;
        let kernel = Arc::new(Kernel::new(gpu, &program, entry_point));
        built.insert(key, Arc::clone(&kernel));
        Ok(kernel)
    }
}
