//! Projected Tetrahedra: silhouette class, thick vertex and triangle fan of one tetrahedron in one view.
