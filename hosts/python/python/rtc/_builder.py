"""Scenes from code: cameras, lights, materials, shapes and meshes of numpy arrays."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Dict, List, Mapping, NewType, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _rtc
from ._meshes import faces_of, vertices_of, per_vertex
from ._values import Json, Vector, vector
from ._values import plain as plain_value

if TYPE_CHECKING:
    from ._scenes import Scene

Texture = NewType("Texture", int)
"""A texture of a builder, for the maps of materials."""
MeshId = NewType("MeshId", int)
"""A mesh of a builder, for its instances."""
MaterialId = NewType("MaterialId", int)
"""A material of a builder, for several objects."""


@dataclass(frozen=True)
class Camera:
    """A camera at `eye` that looks at `center`. `fov` is the vertical field of view in degrees; with `height` the
    camera is orthographic and shows so much of the world. `lens` is a radius and a number of samples."""

    eye: Vector
    center: Vector = (0.0, 0.0, 0.0)
    up: Optional[Vector] = None
    size: Tuple[int, int] = (400, 400)
    fov: Optional[float] = 45.0
    height: Optional[float] = None
    lens: Optional[Tuple[float, int]] = None

    def _words(self) -> _rtc.CameraWords:
        return {
            "eye": vector(self.eye),
            "center": vector(self.center),
            "up": None if self.up is None else vector(self.up),
            "size": [int(side) for side in self.size],
            "fov": None if self.fov is None else float(self.fov),
            "height": None if self.height is None else float(self.height),
            "lens": None if self.lens is None else (float(self.lens[0]), int(self.lens[1])),
        }

    @classmethod
    def _of(cls, words: _rtc.CameraWords) -> Camera:
        width, height = words["size"]
        return cls(vector(words["eye"]), vector(words["center"]), size=(width, height), fov=words["fov"])


@dataclass(frozen=True)
class Light:
    """A light. `sun`, `point`, `spot` and `plain` make one; `kind` says which it is. `dataclasses.replace` changes it."""

    kind: str
    intensity: Vector
    position: Optional[Vector] = None
    direction: Optional[Vector] = None
    angles: Optional[Tuple[float, float]] = None
    range: Optional[float] = None
    radius: Optional[float] = None
    _index: Optional[int] = field(default=None, repr=False, compare=False)

    def _words(self) -> _rtc.LightWords:
        return {
            "kind": self.kind,
            "position": None if self.position is None else vector(self.position),
            "direction": None if self.direction is None else vector(self.direction),
            "intensity": vector(self.intensity),
            "angles": None if self.angles is None else [float(angle) for angle in self.angles],
            "range": None if self.range is None else float(self.range),
            "radius": None if self.radius is None else float(self.radius),
        }

    @classmethod
    def _of(cls, words: _rtc.LightWords, index: int) -> Light:
        position, direction = words["position"], words["direction"]
        return cls(
            words["kind"],
            vector(words["intensity"]),
            None if position is None else vector(position),
            None if direction is None else vector(direction),
            _index=index,
        )


def sun(direction: ArrayLike, irradiance: ArrayLike) -> Light:
    """Parallel light of an irradiance in W/m² on a surface that faces it; `direction` points to it."""
    return Light("sun", vector(irradiance), direction=vector(direction))


def point(position: ArrayLike, intensity: ArrayLike, *, range: Optional[float] = None) -> Light:
    """A point of an intensity in W/sr, that falls off with the square of the distance."""
    return Light("point", vector(intensity), vector(position), range=range)


def spot(
    position: ArrayLike,
    direction: ArrayLike,
    intensity: ArrayLike,
    *,
    angles: Tuple[float, float] = (0.0, np.pi / 4),
    range: Optional[float] = None,
) -> Light:
    """A spot; its intensity falls from the first to the second of `angles`, in radians from its axis."""
    return Light("spot", vector(intensity), vector(position), vector(direction), angles, range)


def plain(position: ArrayLike, color: ArrayLike, *, radius: float = 0.0) -> Light:
    """A light of the course's model, without falloff; a radius above 0 makes soft shadows."""
    return Light("plain", vector(color), vector(position), radius=radius)


class Material:
    """A material: its values are attributes, as `material.roughness`, and are the keys of the IR in snake case.

    `Standard` and `Phong` make one. Those of a scene change it when they are set: `scene.materials[0].roughness = 0.2`.
    """

    kind: str
    _scene: Optional[Tuple[Scene, int]]
    _values: Dict[str, Json]

    def __init__(self, kind: str, values: Mapping[str, object]):
        object.__setattr__(self, "_scene", None)
        object.__setattr__(self, "kind", kind)
        object.__setattr__(self, "_values", {})
        for name, value in values.items():
            setattr(self, name, value)

    @classmethod
    def _of(cls, text: str, scene: Scene, index: int) -> Material:
        [(kind, values)] = json.loads(text).items()
        material = cls(kind, {})
        material._values.update(values)
        object.__setattr__(material, "_scene", (scene, index))
        return material

    def _text(self) -> str:
        return json.dumps({self.kind: {**_defaults(self.kind), **self._values}})

    def __getattr__(self, name: str) -> Json:
        key = _key(name)
        if name.startswith("_"):
            raise AttributeError(name)
        values = {**_defaults(self.kind), **self._values}
        if key not in _names(self.kind):
            raise AttributeError(f"a {self.kind} material has no `{name}`; it has {', '.join(map(_snake, _names(self.kind)))}")
        return values.get(key)

    def __setattr__(self, name: str, value: object) -> None:
        key = _key(name)
        if key not in _names(self.kind):
            raise AttributeError(f"a {self.kind} material has no `{name}`; it has {', '.join(map(_snake, _names(self.kind)))}")
        before = dict(self._values)
        if value is None:
            self._values.pop(key, None)
        else:
            self._values[key] = _value(self.kind, key, value)
        if self._scene is not None:
            scene, index = self._scene
            try:
                scene._held.set_material(index, self._text())
            except ValueError:
                self._values.clear()
                self._values.update(before)
                raise

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *map(_snake, _names(self.kind))]

    def __repr__(self) -> str:
        values = ", ".join(f"{_snake(key)}={value}" for key, value in self._values.items())
        return f"rtc.{self.kind.capitalize()}({values})"


def Standard(**values: object) -> Material:
    """The metallic-roughness material of glTF: `base_color` (three or four numbers), `metallic`, `roughness`, `emissive`,
    `transmission`, `ior` and the others of the IR; a map is a texture of the builder, as `base_color_map`."""
    return Material("standard", values)


def Phong(**values: object) -> Material:
    """The Phong material of the course: `color`, `ka`, `kd`, `ks`, `n`, `kt`, `eta` and the others of the IR."""
    return Material("phong", values)


def _key(name: str) -> str:
    head, *rest = name.split("_")
    return head + "".join(word.capitalize() for word in rest)


def _snake(key: str) -> str:
    return "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in key)


_KNOWN: Dict[str, Tuple[Dict[str, Json], List[str]]] = {}


def _known(kind: str) -> Tuple[Dict[str, Json], List[str]]:
    """The default values of a material, and the names of all."""
    if kind not in _KNOWN:
        defaults, names = _rtc.material_values(kind)
        _KNOWN[kind] = json.loads(defaults)[kind], names
    return _KNOWN[kind]


def _defaults(kind: str) -> Dict[str, Json]:
    return _known(kind)[0]


def _names(kind: str) -> List[str]:
    return _known(kind)[1]


def _value(kind: str, key: str, value: object) -> Json:
    value = plain_value(value)
    is_map = key.endswith("Map") and isinstance(value, int)
    if kind == "standard" and is_map:
        return {"texture": value}
    if key == "baseColor" and isinstance(value, list) and len(value) == 3:
        return [*value, 1.0]
    return value


@dataclass(frozen=True)
class Shape:
    """A shape by its values in the IR; the functions of this module make one."""

    kind: str
    values: Dict[str, List[float]]


def _shape(kind: str, **values: ArrayLike) -> Shape:
    return Shape(kind, {name: np.asarray(value, np.float64).ravel().tolist() for name, value in values.items()})


def sphere(center: ArrayLike, radius: float) -> Shape:
    return _shape("sphere", center=center, radius=radius)


def plane(center: ArrayLike, normal: ArrayLike) -> Shape:
    return _shape("plane", center=center, normal=normal)


def triangle(vertices: ArrayLike) -> Shape:
    """By three corners."""
    return _shape("triangle", vertices=vertices)


def quad(vertices: ArrayLike) -> Shape:
    """By four corners, in order around it."""
    return _shape("quad", vertices=vertices)


def disc(center: ArrayLike, normal: ArrayLike, radius: float) -> Shape:
    return _shape("disc", center=center, normal=normal, radius=radius)


def cylinder(base: ArrayLike, axis: ArrayLike, height: float, radius: float) -> Shape:
    """With two caps; `axis` is its direction from the base."""
    return _shape("cylinder", base=base, axis=axis, height=height, radius=radius)


def cone(base: ArrayLike, up: ArrayLike, radius: float) -> Shape:
    """With a cap at its base; `up` goes from there to the tip."""
    return _shape("cone", base=base, up=up, radius=radius)


def torus(center: ArrayLike, axis: ArrayLike, major: float, minor: float) -> Shape:
    """`major` is the radius of its circle, `minor` that of the tube."""
    return _shape("torus", center=center, axis=axis, major=major, minor=minor)


def ellipsoid(center: ArrayLike, axes: ArrayLike) -> Shape:
    """By three half axes, one a row."""
    return _shape("ellipsoid", center=center, axes=axes)


@dataclass(frozen=True)
class Object:
    """An object of a scene. `material` is an index of its materials; `bounds` has two corners, None if it is infinite."""

    name: str
    kind: str
    material: int
    bounds: Optional[NDArray[np.float64]]


class SceneBuilder:
    """A scene in the making.

    >>> builder = rtc.SceneBuilder(rtc.Camera(eye=(0, 0, 6), size=(320, 240)))
    >>> builder.add(rtc.sphere((0, 0, 0), 1), rtc.Standard(base_color=(1, 0.2, 0.1), roughness=0.4))
    >>> builder.light(rtc.sun((1, 1, 1), (3, 3, 3)))
    >>> image = builder.build().render(spp=16)
    """

    def __init__(self, camera: Camera):
        self._held = _rtc.Builder(camera._words())

    def light(self, light: Light) -> None:
        """Adds a light."""
        self._held.light(light._words())

    def environment(self, radiance: ArrayLike, *, tint: ArrayLike = (1.0, 1.0, 1.0), turn: float = 0.0) -> None:
        """Light from all sides: three numbers, or a picture of all directions, height × width × 3 and linear, its
        middle towards -z; `turn` are degrees about +y."""
        values = np.asarray(radiance, np.float32)
        if values.shape == (3,):
            self._held.environment(vector(values), None, 0.0)
            return
        height, width = _picture(values, "an environment")
        self._held.environment(vector(tint), (width, height, values[..., :3].tobytes()), float(turn))

    def texture(self, pixels: ArrayLike) -> Texture:
        """A texture, height × width × 3: uint8 in sRGB, or linear floats."""
        values = np.asarray(pixels)
        height, width = _picture(values, "a texture")
        is_float = values.dtype != np.uint8
        values = values[..., :3].astype(np.float32 if is_float else np.uint8)
        return Texture(self._held.texture(width, height, values.tobytes(), is_float))

    def material(self, material: Material) -> MaterialId:
        """A material for several objects."""
        return MaterialId(self._held.material(material._text()))

    def mesh(
        self,
        vertices: ArrayLike,
        faces: ArrayLike,
        *,
        normals: Optional[ArrayLike] = None,
        uvs: Optional[ArrayLike] = None,
        colors: Optional[ArrayLike] = None,
    ) -> MeshId:
        """A mesh, to be placed by `add`. `vertices` are n × 3, `faces` m × 3 indices; `normals` n × 3, `uvs` n × 2 (v down,
        as in glTF), `colors` n × 3 or n × 4, in 8 bits or from 0 to 1, linear."""
        points = vertices_of(vertices)
        corners = faces_of(faces, len(points))
        columns = {
            "normals": None if normals is None else per_vertex(normals, points, "normals", (3,)),
            "uvs": None if uvs is None else per_vertex(uvs, points, "uvs", (2,)),
            "colors": None if colors is None else _opaque(per_vertex(colors, points, "colors", (3, 4))),
        }
        held = {name: None if own is None else own.astype(np.float32).tobytes() for name, own in columns.items()}
        return MeshId(self._held.mesh(points.tobytes(), corners.astype(np.uint32).tobytes(), **held))

    def add(
        self,
        shape: Union[Shape, MeshId],
        material: Union[Material, MaterialId],
        *,
        transform: Optional[ArrayLike] = None,
        name: Optional[str] = None,
    ) -> None:
        """Adds an object: a shape, or a mesh of this builder with a 4 × 4 or 3 × 4 `transform`."""
        own = self.material(material) if isinstance(material, Material) else material
        if isinstance(shape, Shape):
            if transform is not None:
                raise ValueError("`transform` places a mesh; a shape has its place in its values")
            self._held.shape(shape.kind, shape.values, own, name)
            return
        matrix = np.asarray(np.eye(4) if transform is None else transform, np.float64)
        if matrix.shape not in [(4, 4), (3, 4)]:
            raise ValueError(f"a transform is 4 × 4 or 3 × 4 numbers, not {matrix.shape}")
        self._held.instance(shape, matrix[:3].T.tolist(), own, name)

    def set(self, **settings: object) -> None:
        """Any settings by their names in the IR, as `set(lightSamples=4)`."""
        for name, value in settings.items():
            self._held.set(name, json.dumps(plain_value(value)))

    def build(self) -> Scene:
        """The scene; raises SceneError with all findings if it is not valid."""
        from ._scenes import Scene

        return Scene(self._held.build(), "scene")


def _picture(values: np.ndarray, what: str) -> Tuple[int, int]:
    if values.ndim != 3 or values.shape[2] not in (3, 4) or 0 in values.shape:
        raise ValueError(f"{what} is height × width × 3 numbers, not {values.shape}")
    return values.shape[0], values.shape[1]


def _opaque(colors: np.ndarray) -> np.ndarray:
    scale = 255.0 if np.issubdtype(colors.dtype, np.integer) else 1.0
    return np.column_stack([colors / scale, np.ones(len(colors))])[:, :4]

