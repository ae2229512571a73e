//! Typed indices, so that one table cannot be indexed by another's key.

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// The index as a `usize`, for indexing slices.
            #[inline]
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl From<u32> for $name {
            #[inline]
            fn from(index: u32) -> Self {
                Self(index)
            }
        }
    };
}

id!(
    /// A point of a mesh.
    VertexId
);
id!(
    /// A tetrahedron of a [`TetMesh`](crate::TetMesh).
    CellId
);
id!(
    /// A triangle between two tetrahedra, or between one and the outside.
    FaceId
);
