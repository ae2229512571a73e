//! One program: its text, what it binds, and whether it is valid.

use naga::valid::{Capabilities, GlobalUse, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, ImageClass, Module, StorageAccess, TypeInner};

use crate::compose::{Slot, join};
use crate::constants::{Constant, prelude};

/// What programs may use beyond the core of the language: nothing.
pub const CAPABILITIES: Capabilities = Capabilities::empty();

/// Why there is no program.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ShaderError {
    /// A file that is used is not in the folder.
    #[error("{user} uses {path}, which is not among the shaders; add it to the folder and to the list of sources")]
    NoSuchFile {
        /// The file.
        path: String,
        /// Who uses it.
        user: String,
    },
    /// A slot is to be filled by the caller.
    #[error("{path} has a slot <{slot}>, and nothing was named for it")]
    EmptySlot {
        /// The slot.
        slot: String,
        /// The file that has it.
        path: String,
    },
    /// The joined text is no program.
    #[error("{program} is not valid: {problem}")]
    Invalid {
        /// The file that the program begins with.
        program: String,
        /// What the validator says, with the place in the joined text.
        problem: String,
    },
}

/// A program, joined and validated.
#[derive(Clone, Debug)]
pub struct Program {
    name: String,
    source: String,
    module: Module,
    info: ModuleInfo,
}

/// What a program may do with a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Read only.
    Read,
    /// Read, and write.
    ReadWrite,
}

/// What is bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// A uniform buffer.
    Uniform,
    /// A storage buffer.
    Storage(Access),
    /// A texture that is loaded from, of unfilterable floats.
    Texture,
}

/// One thing that an entry point uses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// The variable's name; one name has one number in all programs.
    pub name: String,
    /// Number within the one group.
    pub number: u32,
    /// What is bound.
    pub kind: BindingKind,
}

impl Program {
    /// Joins a file with what it uses and validates the whole.
    ///
    /// - `slots`: files for the slots that it and what it uses have; others are ignored
    /// - `constants`: put in front, besides those that all programs have
    ///
    /// # Errors
    /// [`ShaderError`] for a missing file, an empty slot, or text that is no valid program.
    pub fn compose(path: &str, slots: &[Slot<'_>], constants: &[(&str, Constant)]) -> Result<Self, ShaderError> {
        let source = format!("{}{}", prelude(constants), join(path, slots)?);
        let invalid = |problem| ShaderError::Invalid { program: path.to_owned(), problem };
        let module = naga::front::wgsl::parse_str(&source).map_err(|error| invalid(error.emit_to_string(&source)))?;
        let info = Validator::new(ValidationFlags::all(), CAPABILITIES)
            .validate(&module)
            .map_err(|error| invalid(error.emit_to_string(&source)))?;
        Ok(Self { name: path.to_owned(), source, module, info })
    }

    /// The file that the program begins with.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The joined text.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// What it consists of.
    pub fn module(&self) -> &Module {
        &self.module
    }

    /// Names of the entry points.
    pub fn entry_points(&self) -> impl Iterator<Item = &str> {
        self.module.entry_points.iter().map(|entry| entry.name.as_str())
    }

    /// What an entry point uses, by ascending number; nothing for a name that is none.
    pub fn bindings(&self, entry_point: &str) -> Vec<Binding> {
        let Some(index) = self.module.entry_points.iter().position(|entry| entry.name == entry_point) else {
            return Vec::new();
        };
        let used = self.info.get_entry_point(index);
        let mut bindings: Vec<Binding> = self
            .module
            .global_variables
            .iter()
            .filter(|(handle, _)| used[*handle] != GlobalUse::empty())
            .filter_map(|(_, variable)| {
                let place = variable.binding.as_ref()?;
                let kind = match variable.space {
                    AddressSpace::Uniform => BindingKind::Uniform,
                    AddressSpace::Storage { access } if access.contains(StorageAccess::STORE) => {
                        BindingKind::Storage(Access::ReadWrite)
                    }
                    AddressSpace::Storage { .. } => BindingKind::Storage(Access::Read),
                    _ => match self.module.types[variable.ty].inner {
                        TypeInner::Image { class: ImageClass::Sampled { .. }, .. } => BindingKind::Texture,
                        _ => return None,
                    },
                };
                Some(Binding { name: variable.name.clone().unwrap_or_default(), number: place.binding, kind })
            })
            .collect();
        bindings.sort_by_key(|binding| binding.number);
        bindings
    }

    /// The workgroup size of a compute entry point; `None` for a name that is none.
    pub fn workgroup_size(&self, entry_point: &str) -> Option<[u32; 3]> {
        let entry = self.module.entry_points.iter().find(|entry| entry.name == entry_point)?;
        Some(entry.workgroup_size)
    }
}
