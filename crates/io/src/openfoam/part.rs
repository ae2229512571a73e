//! One mesh of a case with its fields at one time: a region, or what one processor has of it.

use std::path::{Path, PathBuf};

use glam::DVec3;
use tetrascope_mesh::UnstructuredCells;

use super::{
    case::{TimeFolder, instance_of},
    collated::Blocks,
    fields::{Budget, Class, Field, Outcome, Owner, field_files},
    file::{DAMAGED, FoamFile, existing, peek_class},
    mesh::{MeshFolders, PolyMesh},
    patches::processor_patches,
};
use crate::IoError;

/// Where a part lies.
#[derive(Clone, Debug)]
pub(super) struct PartFolders {
    /// The folder with `constant` in it.
    pub(super) root: PathBuf,
    /// The folder below `constant` and the times, of a case of several regions.
    pub(super) region: Option<String>,
    /// Its number among the regions.
    pub(super) region_number: i32,
    /// Whether it is what one of several processors has.
    pub(super) decomposed: bool,
    /// Which block of the files it is, where processors have written into them together.
    pub(super) block: Option<usize>,
}

/// What was read of a part.
#[derive(Debug)]
pub(super) struct Part {
    /// Its number among the regions.
    pub(super) region: i32,
    pub(super) points: Vec<DVec3>,
    pub(super) cells: UnstructuredCells,
    pub(super) fields: Vec<Field>,
    /// Faces that other processors have too.
    pub(super) shared: Vec<SharedFaces>,
    /// Whether a file of the mesh is in binary.
    pub(super) binary: bool,
}

/// The faces that two processors both have, as points of the one.
#[derive(Debug)]
pub(super) struct SharedFaces {
    pub(super) own: usize,
    pub(super) other: usize,
    pub(super) faces: Vec<Vec<u32>>,
}

impl Part {
    /// Reads the mesh as it is at a step, and the fields of that step.
    pub(super) fn read(
        folders: &PartFolders,
        times: &[TimeFolder],
        step: usize,
        blocks: &mut Blocks,
        budget: &mut Budget,
        warnings: &mut Vec<String>,
    ) -> Result<Self, IoError> {
        let below = match &folders.region {
            Some(region) => Path::new(region).join("polyMesh"),
            None => PathBuf::from("polyMesh"),
        };
        let until = times.get(..=step).unwrap_or(times);
        let points = instance_of(&folders.root, until, &below, "points");
        let faces = instance_of(&folders.root, until, &below, "faces");
        let mut open = |path: &Path| blocks.open(path, folders.block);
        let mesh = PolyMesh::read(&MeshFolders { points: &points, faces: &faces }, &mut open)?;
        budget.bytes = budget.bytes.saturating_add(mesh.bytes);
        // Of a whole mesh nothing in there is needed.
        let boundary = faces.join("boundary");
        let shared = match folders.decomposed && existing(&boundary).is_some() {
            true => shared_faces(&mesh, &open(&boundary)?)?,
            false => Vec::new(),
        };
        let (cells, without_volume) = mesh.cells();
        if without_volume > 0 {
            warnings.push(format!(
                "{without_volume} of {} cells in {} have fewer than four faces and enclose nothing; they are not drawn",
                mesh.cell_count,
                faces.display()
            ));
        }
        let (region, binary, points) = (folders.region_number, mesh.binary, mesh.points);
        let mut part = Self { region, points, cells, fields: Vec::new(), shared, binary };
        if let Some(time) = times.get(step) {
            let folder = folders.root.join(&time.name);
            let folder = folders.region.as_ref().map_or_else(|| folder.clone(), |region| folder.join(region));
            part.read_fields(&folder, folders.block, blocks, budget, warnings)?;
        }
        Ok(part)
    }

    fn read_fields(
        &mut self,
        folder: &Path,
        block: Option<usize>,
        blocks: &mut Blocks,
        budget: &mut Budget,
        warnings: &mut Vec<String>,
    ) -> Result<(), IoError> {
        let mut on_faces = Vec::new();
        for (name, path) in field_files(folder) {
            let Some(mut class) = peek_class(&path) else { continue };
            if block.is_some() {
                class = blocks.class(&path)?;
            }
            let class = Class::of(&class);
            if !matches!(class, Class::Field { .. }) {
                blocks.forget(&path);
            }
            let (owner, components) = match class {
                Class::Field { owner, components } => (owner, components),
                Class::OnFaces => {
                    on_faces.push(name);
                    continue;
                }
                Class::Other => continue,
            };
            let expected = match owner {
                Owner::Cell => self.cells.kinds.len(),
                Owner::Point => self.points.len(),
            };
            let file = blocks.open(&path, block)?;
            match Field::read(&file, name, (owner, components), expected, budget)? {
                Outcome::Field(field) => self.fields.push(field),
                Outcome::LeftOut(reason) => {
                    warnings.push(format!("the field in {} is left out: {reason}", path.display()))
                }
            }
        }
        if !on_faces.is_empty() {
            let (verb, noun) = if on_faces.len() == 1 { ("is", "a field") } else { ("are", "fields") };
            warnings
                .push(format!("{} {verb} left out: {noun} on faces, of which a volume has none", on_faces.join(", ")));
        }
        Ok(())
    }
}

/// The faces of the patches between processors.
fn shared_faces(mesh: &PolyMesh, file: &FoamFile) -> Result<Vec<SharedFaces>, IoError> {
    let mut named = 0_usize;
    let mut found = Vec::new();
    for patch in processor_patches(file)? {
        // A face is in one patch; patches that name all of them again and again would come to any amount.
        named = named.saturating_add(patch.face_count);
        let last = patch.first_face.saturating_add(patch.face_count);
        if last > mesh.faces.len() || named > mesh.faces.len() {
            let problem = format!(
                "its {} faces from {} on are not there, or are in two patches",
                patch.face_count, patch.first_face
            );
            return Err(file.source.invalid(format!("the patch to processor {}", patch.other), problem, DAMAGED));
        }
        let faces = (patch.first_face..last).map(|face| mesh.faces.row(face).to_vec()).collect();
        found.push(SharedFaces { own: patch.own, other: patch.other, faces });
    }
    Ok(found)
}
