//! Structures of both languages, field by field.

use std::mem::offset_of;

use naga::TypeInner;

use crate::Program;
use crate::layout::Frame;

/// Name, offset and bytes of every field, and bytes of the whole.
type Fields = (Vec<(&'static str, u32)>, u32);

macro_rules! fields {
    ($type:ty: $($field:ident),*) => {
        (vec![$((stringify!($field), offset_of!($type, $field) as u32)),*], size_of::<$type>() as u32)
    };
}

/// The same of a structure in a file of the shaders.
fn of_shader(file: &str, name: &str) -> (Vec<(String, u32)>, u32) {
    let program = Program::compose(file, &[], &[]).unwrap();
    let (_, found) = program.module().types.iter().find(|(_, found)| found.name.as_deref() == Some(name)).unwrap();
    let TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no structure") };
    (members.iter().map(|member| (member.name.clone().unwrap(), member.offset)).collect(), *span)
}

#[test]
fn structures_are_the_same_in_both_languages() {
    let known: [(&str, &str, Fields); 1] = [(
        "include/frame.wgsl",
        "Frame",
        fields!(Frame: right, down, forward, eye, columns, rows, rest, slope, size, origin, extent, tiles, is_perspective,
            termination, cells, points),
    )];
    for (file, name, (fields, bytes)) in known {
        let (shader_fields, shader_bytes) = of_shader(file, name);
        let own: Vec<(String, u32)> = fields.iter().map(|(field, offset)| ((*field).to_owned(), *offset)).collect();
        assert_eq!(own, shader_fields, "{name}");
        assert_eq!(bytes, shader_bytes, "{name}");
    }
}
