//! What a scene is refused for.

use thiserror::Error;

/// A scene, a pose or a picture that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SceneError {
    /// A length, a place or a height is no finite number, or a length is negative.
    #[error("{what} is no finite number")]
    NotFinite {
        /// Which one.
        what: String,
    },
    /// A triangle names a vertex that is not there.
    #[error("face {face} of mesh {mesh} names a vertex that is not there")]
    Face {
        /// Index of the mesh.
        mesh: usize,
        /// Index of the triangle.
        face: usize,
    },
    /// A mesh without triangles.
    #[error("mesh {mesh} has no triangles")]
    Empty {
        /// Index of the mesh.
        mesh: usize,
    },
    /// Heights that do not lie on a lattice of points.
    #[error("height field {field} is no rectangle of 2 x 2 heights or more")]
    Rectangle {
        /// Index of the height field.
        field: usize,
    },
    /// A body names a mesh or a height field that is not there.
    #[error("body {body} has a mesh or a height field that is not there")]
    Form {
        /// Index of the body.
        body: usize,
    },
    /// An array is not as long as it must be.
    #[error("{what} must have {wanted} values, got {found}")]
    Length {
        /// Which one.
        what: &'static str,
        /// How many.
        wanted: usize,
        /// How many there are.
        found: usize,
    },
    /// A camera without pixels or without a focal length.
    #[error("a camera's width, height and focal length must be > 0")]
    Camera,
}

/// Refuses an array that is not as long as it must be.
pub(crate) const fn of_length(
    what: &'static str,
    found: usize,
    wanted: usize,
) -> Result<(), SceneError> {
    if found == wanted {
        Ok(())
    } else {
        Err(SceneError::Length {
            what,
            wanted,
            found,
        })
    }
}
