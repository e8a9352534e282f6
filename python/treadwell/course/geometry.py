"""Pieces of a course as geoms of a MuJoCo specification: ground, light, colours, friction."""

from collections.abc import Sequence
from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell.course.height_field import FieldPiece
from treadwell.course.outlines import Floats
from treadwell.course.pieces import Piece
from treadwell.scenario.element_table import ElementTable
from treadwell.scenario.elements import Box
from treadwell.scenario.ground_elements import Patch

PREFIX: Final = "course/"
"""Before the names of a course's bodies and geoms, so that none is also a robot's."""
GROUND: Final = "ground"
STEMS: Final = "stems"
"""Ends the name of the geom of all that is seen of an element and gives way."""
PARKED: Final = -100.0
"""Height of an element that is not there, metres."""
COLOURS: Final[dict[str, tuple[float, float, float]]] = {
    "stairs": (0.83, 0.71, 0.53),
    "sill": (0.72, 0.53, 0.34),
    "platform": (0.80, 0.69, 0.52),
    "ramp": (0.76, 0.67, 0.53),
    "box": (0.79, 0.35, 0.27),
    "cylinder": (0.16, 0.47, 0.56),
    "wall": (0.90, 0.88, 0.83),
    "door": (0.62, 0.44, 0.28),
    "rubble": (0.50, 0.47, 0.45),
    "patch": (0.5, 0.5, 0.5),
    "vegetation": (0.33, 0.50, 0.22),
    "terrain": (0.62, 0.58, 0.44),
    "slabs": (0.66, 0.64, 0.60),
    "mesh": (0.50, 0.42, 0.60),
}
HANGING: Final = (0.91, 0.62, 0.20)
"""Colour of a box that hangs above the ground."""
FLAT: Final = 1e-3
"""Height of a field that has none, metres: MuJoCo wants one."""
FILE_FRICTION: Final = (0.005, 0.0001)
"""Torsional and rolling friction, which only count where a geom asks for them."""


def add_ground(spec: mujoco.MjSpec, friction: float) -> None:
    """Add the ground plane z = 0 with a fine chequer, a sky and the light."""
    spec.add_texture(
        name=PREFIX + "sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=[0.93, 0.95, 0.97],
        rgb2=[0.62, 0.72, 0.82],
        width=64,
        height=384,
    )
    spec.add_texture(
        name=PREFIX + "floor",
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=[0.80, 0.82, 0.81],
        rgb2=[0.73, 0.76, 0.76],
        width=256,
        height=256,
    )
    material = spec.add_material(
        name=PREFIX + "floor", texrepeat=[2.0, 2.0], texuniform=True, specular=0.1, shininess=0.1
    )
    textures = list(material.textures)
    textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = PREFIX + "floor"
    material.textures = textures
    spec.worldbody.add_light(
        name=PREFIX + "sun",
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        pos=[0.0, 0.0, 4.0],
        dir=[-0.3, 0.35, -1.0],
        diffuse=[0.65, 0.65, 0.62],
        ambient=[0.28, 0.28, 0.30],
        specular=[0.1, 0.1, 0.1],
    )
    spec.worldbody.add_geom(
        name=GROUND,
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0.0, 0.0, 0.05],
        material=PREFIX + "floor",
        rgba=[1.0, 1.0, 1.0, 1.0],
        **_contact(friction),
    )
    spec.stat.center = [1.0, 0.0, 0.3]
    spec.stat.extent = 3.0


def _contact(friction: float) -> dict[str, object]:
    """Return what decides a geom's contacts, said outright: a robot's defaults must not."""
    return {
        "contype": 1,
        "conaffinity": 1,
        "condim": 3,
        "group": 0,
        "priority": 0,
        "margin": 0.0,
        "friction": [friction, *FILE_FRICTION],
    }


def colour(element: ElementTable, number: int) -> tuple[float, float, float, float]:
    """Return the colour (r, g, b, a) of an element's piece; neighbours differ a little."""
    kind = str(getattr(element, "kind", "box"))
    red, green, blue = COLOURS.get(kind, (0.6, 0.6, 0.6))
    if isinstance(element, Box) and element.base > 0.0:
        red, green, blue = HANGING
    if isinstance(element, Patch):
        red = green = blue = element.shade
    shade = 1.0 if number % 2 == 0 else 0.88
    return red * shade, green * shade, blue * shade, 1.0


def add_pieces(
    spec: mujoco.MjSpec,
    body: mujoco.MjsBody,
    name: str,
    element: ElementTable,
    pieces: Sequence[Piece],
    *,
    origin: Floats,
    friction: float,
    shape: tuple[Floats, Floats] | None = None,
) -> list[str]:
    """Add an element's pieces to a body and return the geoms' names.

    Args:
        spec: the course.
        body: the world, or the element's own body.
        name: the element's name.
        element: for its colour.
        pieces: in the world frame.
        origin: (3,) the body's place in the world; it is not turned.
        friction: sliding friction.
        shape: vertices and faces of the visible shape of a mesh, in the world frame.
    """
    names = []
    for number, piece in enumerate(pieces):
        geom_name = f"{PREFIX}{name}/{piece.name}"
        names.append(geom_name)
        common = {"name": geom_name, "rgba": list(colour(element, number)), **_contact(friction)}
        if isinstance(element, Patch):
            common["friction"] = [element.friction, *FILE_FRICTION]
        if isinstance(piece, FieldPiece):
            _add_field(spec, body, piece, common)
            continue
        if piece.shape == "hull":
            mesh = spec.add_mesh(name=geom_name)
            vertices = piece.vertices if shape is None else shape[0]
            mesh.uservert = (vertices - origin).ravel().tolist()
            if shape is not None:
                mesh.userface = shape[1].ravel().tolist()
            mesh.inertia = (
                mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
                if shape is not None
                else (mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX)
            )
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=geom_name, **common)
            continue
        kind = {"box": mujoco.mjtGeom.mjGEOM_BOX, "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER}
        body.add_geom(
            type=kind[piece.shape],
            pos=(piece.center - origin).tolist(),
            quat=piece.quaternion.tolist(),
            size=piece.size.tolist(),
            **common,
        )
    return names


def _add_field(
    spec: mujoco.MjSpec, body: mujoco.MjsBody, piece: FieldPiece, common: dict[str, object]
) -> None:
    """Add a height field's geom; MuJoCo stretches what it is given over all of the height."""
    field = piece.field
    low = float(field.heights.min())
    rows, columns = field.heights.shape
    most = max(float(field.heights.max()) - low, FLAT)
    spec.add_hfield(
        name=str(common["name"]),
        nrow=rows,
        ncol=columns,
        size=[*field.half, most, low - field.bottom],
        userdata=((field.heights - low) / most).ravel().tolist(),
    )
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_HFIELD,
        hfieldname=common["name"],
        pos=[*field.middle, low],
        quat=piece.quaternion.tolist(),
        **common,
    )


def add_stems(
    spec: mujoco.MjSpec, name: str, element: ElementTable, shape: tuple[Floats, NDArray[np.int32]]
) -> None:
    """Add what is seen of an element and gives way: one geom, a mesh that nothing touches.

    Args:
        spec: the course.
        name: the element's.
        element: for its colour.
        shape: vertices (n, 3) m, world, and faces (m, 3).
    """
    vertices, faces = shape
    geom_name = f"{PREFIX}{name}/{STEMS}"
    spec.add_mesh(
        name=geom_name,
        uservert=vertices.ravel().tolist(),
        userface=faces.ravel().tolist(),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    untouched = {**_contact(0.0), "contype": 0, "conaffinity": 0}
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=geom_name,
        name=geom_name,
        rgba=list(colour(element, 0)),
        **untouched,
    )


def add_movable_body(
    spec: mujoco.MjSpec, name: str, origin: Floats, *, present: bool
) -> mujoco.MjsBody:
    """Add the body of an element that events move: driven by `mocap_pos`, parked when not there."""
    place = origin if present else parked(origin)
    return spec.worldbody.add_body(name=PREFIX + name, mocap=True, pos=place.tolist())


def parked(origin: Floats) -> Floats:
    """Return where an element is kept, far below, while it is not there, (3,)."""
    return np.array([origin[0], origin[1], PARKED])
