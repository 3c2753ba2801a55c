"""Exact intersection of rays with bicubic Bezier patches: libpscn for numpy.

    import numpy as np, pscn
    scene = pscn.Scene.from_file("teapot.pscn")
    origins, directions = scene.camera_rays(640, 480)
    hits = scene.nearest(origins, directions)
    depth = hits.t * np.linalg.norm(directions, axis=-1)

A scene is made once and never changes. Its calls release Python's lock, so threads may share it. Arrays of rays have
any shape (..., 3), and two of them are broadcast; answers have that shape without the 3. Promises, units and limits are
those of pscn.h (`man 3 pscn`). PSCN_LIBRARY is the path of libpscn.so where the system does not find it.
"""
from __future__ import annotations

import ctypes
import ctypes.util
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from typing import Unpack

__all__ = ["Scene", "Options", "Hits", "Counts", "Surface", "Part", "Error", "version"]

# The structures of pscn.h.
_RAY = np.dtype([("origin", "3f8"), ("direction", "3f8"), ("t_min", "f8"), ("t_max", "f8")])
_HIT = np.dtype([("t", "f8"), ("u", "f8"), ("v", "f8"), ("point", "3f8"), ("point_error", "f8"), ("clearance", "f8"),
                 ("normal", "3f8"), ("du", "3f8"), ("dv", "3f8"), ("patch", "u4"), ("verdict", "i4"),
                 ("certain", "i4"), ("reserved", "i4")])
_COUNTS = np.dtype([("count", "u8"), ("verdict", "i4"), ("certain", "i4")])
_PLACE = np.dtype([("u", "f8"), ("v", "f8"), ("patch", "u4"), ("reserved", "u4")])
_SURFACE = np.dtype([("point", "3f8"), ("du", "3f8"), ("dv", "3f8"), ("normal", "3f8")])
_OPTIONS = np.dtype([("size", "u8"), ("solver", "u8"), ("tolerance", "f8"), ("max_memory", "u8"), ("folders", "u8"),
                     ("numbers", "u8"), ("number_count", "u8"), ("image_size", "2i4"), ("memory", "2u8"),
                     ("untrusted", "i4"), ("lenient", "i4"), ("clock", "f8"), ("max_work", "u8")])
_PART = np.dtype([("name", "u8"), ("number", "u8"), ("first", "u8"), ("count", "u8")])
_INPUT, _LIMIT, _MISS, _ALL = 3, 5, 0, ctypes.c_size_t(-1).value


class Error(ValueError):
    """An error that libpscn reports; `status` is pscn.h's."""

    def __init__(self, text: str, status: int):
        super().__init__(text)
        self.status = status


class Options(TypedDict, total=False):
    """How a scene is built: keywords of Scene and its from_... methods. Defaults and units are those of pscn.h."""
    solver: str  #: what may follow that word in a scene; replaces every solver statement
    tolerance: float
    max_memory: int  #: bytes that the scene may take
    folders: Sequence[str | os.PathLike]  #: more folders to search for included files
    numbers: Mapping[str, float]  #: declared before the text is read
    image_size: tuple[int, int]  #: image_width and image_height in the text
    untrusted: bool  #: the text is not trusted
    lenient: bool  #: what pscn does not support is left out, with warnings
    clock: float
    max_work: int  #: tokens that loops and macros may read


class Hits:
    """Nearest hits, or all hits: where a ray has none, t is infinite, patch is -1 and the rest 0."""

    def __init__(self, found: np.ndarray):
        self._found = found

    t: NDArray[np.float64] = property(lambda self: self._found["t"], doc="in units of the direction's length")
    u: NDArray[np.float64] = property(lambda self: self._found["u"])
    v: NDArray[np.float64] = property(lambda self: self._found["v"])
    point: NDArray[np.float64] = property(lambda self: self._found["point"])
    normal: NDArray[np.float64] = property(lambda self: self._found["normal"], doc="of unit length, facing the origin")
    patch: NDArray[np.int32] = property(lambda self: self._found["patch"].view(np.int32))
    hit: NDArray[np.bool_] = property(lambda self: self._found["verdict"] == 1)
    certain: NDArray[np.bool_] = property(lambda self: self._found["certain"] == 1, doc="proven")


@dataclass
class Counts:
    """How many hits each ray has, and the first of them along the last axis of `hits`."""
    count: NDArray[np.int64]
    certain: NDArray[np.bool_]  #: the count and the order are proven
    hits: Hits


@dataclass
class Part:
    """An object of a text that stands in no other: its patches, and its name if it is a declared one, or ""."""
    name: str
    patches: range


@dataclass
class Surface:
    """Points of patches, derivatives and unit normals; a normal is 0 if the patch has none."""
    point: NDArray[np.float64]
    du: NDArray[np.float64]
    dv: NDArray[np.float64]
    normal: NDArray[np.float64]


def _load() -> ctypes.CDLL:
    path = os.environ.get("PSCN_LIBRARY") or ctypes.util.find_library("pscn")
    if path is None:
        raise ImportError("libpscn was not found; PSCN_LIBRARY may be its path")
    library = ctypes.CDLL(path)
    p, n, stride, text = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_ssize_t, ctypes.c_char_p
    for name, result, arguments in (
            ("version_text", text, []), ("status_text", text, [ctypes.c_int]), ("scene_messages", text, [p]),
            ("scene_from_file", None, [text, p, p]), ("scene_from_text", None, [text, text, n, p, p]),
            ("scene_from_points", None, [p, n, stride, stride, p, p]),
            ("scene_from_indexed", None, [p, n, p, n, p, n, p, p]), ("scene_free", None, [p]),
            ("scene_camera", None, [p, p]), ("patch_count", n, [p]), ("patch", None, [p, n, p]),
            ("bounds", None, [p, n, p]), ("object", None, [p, n, p]), ("surface", None, [p, n, p, stride, p, stride]),
            ("nearest", None, [p, n, p, stride, p, stride]), ("occluded", None, [p, n, p, stride, p, stride]),
            ("all", None, [p, n, p, stride, p, stride, p, stride, n])):
        function = getattr(library, "pscn_" + name)
        function.restype, function.argtypes = result or ctypes.c_int, arguments
    return library


_library = _load()


def version() -> str:
    """The version of the library that is running."""
    return _library.pscn_version_text().decode()


def _check(status: int) -> None:
    if status == _LIMIT:
        raise MemoryError(_library.pscn_status_text(status).decode())
    if status != 0:
        raise Error(_library.pscn_status_text(status).decode(), status)


def _array(values: ArrayLike, kind, *last: int) -> np.ndarray:
    array = np.ascontiguousarray(values, kind)
    if array.shape[array.ndim - len(last):] != last:
        raise ValueError(f"an array of shape {array.shape}, where the last axes must be {last}")
    return array


_BLOCK = 1 << 13


def _shape(origins, directions, t_min, t_max) -> tuple[int, ...]:
    shapes = np.shape(origins), np.shape(directions)
    if any(shape[-1:] != (3,) for shape in shapes):
        raise ValueError(f"rays of shapes {shapes[0]} and {shapes[1]}, where the last axis must be 3")
    return np.broadcast_shapes(shapes[0][:-1], shapes[1][:-1], np.shape(t_min), np.shape(t_max))


def _flat(values, shape: tuple[int, ...], last: tuple[int, ...]) -> np.ndarray:
    """One value a ray, one after the other; a single one if it is the same for all."""
    array = np.asarray(values, np.float64)
    axes = array.ndim - len(last)
    if array.size > 0 and not any(array.strides[k] and array.shape[k] > 1 for k in range(axes)):
        return array[(0,) * axes].reshape((1,) + last)
    return np.broadcast_to(array, shape + last).reshape((-1,) + last)


class Scene:
    """A scene of patches: of control points nets[..., 4, 4, 3], along u and then along v; or see from_file, from_text
    and from_indexed. Errors are raised with their places."""

    def __init__(self, nets: ArrayLike, **options: Unpack[Options]):
        nets = _array(nets, np.float64, 4, 4, 3)
        self._build("points", options, nets.ctypes.data, nets.size // 48, 384, 24)

    @classmethod
    def from_file(cls, path: str | os.PathLike, **options: Unpack[Options]) -> Scene:
        """A scene file in the language of pscn(5)."""
        return cls.__new__(cls)._build("file", options, os.fsencode(path))

    @classmethod
    def from_text(cls, text: str, *, name: str = "text", **options: Unpack[Options]) -> Scene:
        """The text of such a file; `name` stands for it in messages."""
        data = text.encode()
        return cls.__new__(cls)._build("text", options, os.fsencode(name), data, len(data))

    @classmethod
    def from_indexed(cls, vertices: ArrayLike, patches: ArrayLike, *, instances: ArrayLike | None = None,
                     **options: Unpack[Options]) -> Scene:
        """Patches as indices [..., 16] of vertices [n, 3]; all of them once for each matrix of instances [m, 4, 3]."""
        vertices, patches = _array(vertices, np.float64, 3), _array(patches, np.uint32, 16)
        placed = _array(np.zeros((0, 4, 3)) if instances is None else instances, np.float64, 4, 3)
        return cls.__new__(cls)._build("indexed", options, vertices.ctypes.data, vertices.size // 3, patches.ctypes.data,
                                       patches.size // 16, placed.ctypes.data if placed.size else None,
                                       placed.size // 12)

    def _build(self, kind: str, options: Options, *arguments) -> Scene:
        options = {name: value for name, value in options.items() if value is not None}
        unknown = options.keys() - Options.__annotations__.keys()
        if unknown:
            raise TypeError(f"there is no option {min(unknown)!r}")
        self._handle = ctypes.c_void_p()
        given = np.zeros((), _OPTIONS)
        given["size"] = _OPTIONS.itemsize
        for name in ("tolerance", "max_memory", "image_size", "untrusted", "lenient", "clock", "max_work"):
            given[name] = options.get(name, 0)
        texts = {name: ctypes.create_string_buffer(name.encode()) for name in options.get("numbers", {})}
        solver = ctypes.create_string_buffer(options.get("solver", "").encode())
        numbers = np.array([(ctypes.addressof(texts[name]), value) for name, value in options.get("numbers", {}).items()],
                           [("name", "u8"), ("value", "f8")])
        paths = [os.fsencode(folder) for folder in options.get("folders", ())]
        folders = (ctypes.c_char_p * (len(paths) + 1))(*paths, None)
        given["solver"] = ctypes.addressof(solver) if "solver" in options else 0
        given["folders"], given["numbers"] = ctypes.addressof(folders), numbers.ctypes.data
        given["number_count"] = len(numbers)
        status = getattr(_library, "pscn_scene_from_" + kind)(*arguments, given.ctypes.data, ctypes.byref(self._handle))
        #: warnings
        self.messages = _library.pscn_scene_messages(self._handle).decode()
        if status == _LIMIT:
            raise MemoryError(self.messages)
        if status != 0:
            raise Error(self.messages.rstrip(), status)
        return self

    def __del__(self):
        if getattr(self, "_handle", None):
            _library.pscn_scene_free(self._handle)

    def __len__(self) -> int:
        return _library.pscn_patch_count(self._handle)

    def patch(self, number: int) -> NDArray[np.float64]:
        """The control points [4, 4, 3] of a patch."""
        net = np.empty((4, 4, 3))
        _check(_library.pscn_patch(self._handle, number, net.ctypes.data))
        return net

    @property
    def parts(self) -> list[Part]:
        """The objects of the scene's text, in its order; none if it is not from a text. hits.patch belongs to number
        numpy.searchsorted([part.patches.start for part in scene.parts], hits.patch, "right") - 1."""
        parts, part = [], np.zeros((), _PART)
        while (first := int(part["first"] + part["count"])) < len(self):
            if _library.pscn_object(self._handle, first, part.ctypes.data) != 0:
                break
            parts.append(Part(ctypes.string_at(int(part["name"])).decode(), range(first, first + int(part["count"]))))
        return parts

    def bounds(self, patch: int | None = None) -> NDArray[np.float64]:
        """The least and the greatest coordinates [2, 3] of the control points of a patch, or of all."""
        box = np.empty((2, 3))
        _check(_library.pscn_bounds(self._handle, _ALL if patch is None else patch, box.ctypes.data))
        return box

    def surface(self, patch: ArrayLike, u: ArrayLike, v: ArrayLike) -> Surface:
        """Points of patches at parameters in [0,1]."""
        patch, u, v = np.broadcast_arrays(patch, u, v)
        places, out = np.zeros(u.shape, _PLACE), np.empty(u.shape, _SURFACE)
        places["patch"], places["u"], places["v"] = patch, u, v
        _check(_library.pscn_surface(self._handle, places.size, places.ctypes.data, _PLACE.itemsize, out.ctypes.data,
                                     _SURFACE.itemsize))
        return Surface(*(out[name] for name in _SURFACE.names))

    def camera_rays(self, width: int, height: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Origins and directions [height, width, 3] of the rays through the middles of a picture's pixels."""
        camera = np.empty((4, 3))
        _library.pscn_scene_camera(self._handle, camera.ctypes.data)
        s, t = (np.arange(width) + 0.5) / width - 0.5, 0.5 - (np.arange(height) + 0.5) / height
        directions = camera[1] + s[None, :, None] * camera[2] + t[:, None, None] * camera[3]
        return np.broadcast_to(camera[0], directions.shape), directions

    def _ask(self, function, rays: tuple, out: np.ndarray, *more) -> None:
        """Calls function for the rays, some thousands at a time so that their copies stay in the processor's cache.
        `more` are pairs of a further output's address and its bytes a ray, and numbers."""
        shape = out.shape
        flat = [_flat(values, shape, last) for values, last in zip(rays, ((3,), (3,), (), ()))]
        block = np.empty(min(out.size, _BLOCK), _RAY)
        for first in range(0, out.size, _BLOCK):
            count = min(_BLOCK, out.size - first)
            for name, values in zip(_RAY.names, flat):
                block[name][:count] = values if len(values) == 1 else values[first:first + count]
            rest = [x for address, stride in more[:1] for x in (address + first * stride, stride)]
            _check(function(self._handle, count, block.ctypes.data, _RAY.itemsize,
                            out.ctypes.data + first * out.itemsize, out.itemsize, *rest, *more[1:]))

    def nearest(self, origins: ArrayLike, directions: ArrayLike, *, t_min: ArrayLike = 0,
                t_max: ArrayLike = np.inf) -> Hits:
        """The nearest hit of each ray with t_min < t < t_max."""
        found = np.empty(_shape(origins, directions, t_min, t_max), _HIT)
        self._ask(_library.pscn_nearest, (origins, directions, t_min, t_max), found)
        return Hits(found)

    def occluded(self, origins: ArrayLike, directions: ArrayLike, *, t_min: ArrayLike = 0,
                 t_max: ArrayLike = np.inf) -> NDArray[np.bool_]:
        """Whether each ray hits anything: faster."""
        verdicts = np.empty(_shape(origins, directions, t_min, t_max), np.uint8)
        self._ask(_library.pscn_occluded, (origins, directions, t_min, t_max), verdicts)
        return verdicts != _MISS

    def all(self, origins: ArrayLike, directions: ArrayLike, *, most: int = 8, t_min: ArrayLike = 0,
            t_max: ArrayLike = np.inf) -> Counts:
        """All hits of each ray: their number, and the first `most` of them in order."""
        counts = np.empty(_shape(origins, directions, t_min, t_max), _COUNTS)
        found = np.empty(counts.shape + (most,), _HIT)
        self._ask(_library.pscn_all, (origins, directions, t_min, t_max), counts,
                  (found.ctypes.data, most * _HIT.itemsize), most)
        return Counts(count=counts["count"].astype(np.int64), certain=counts["certain"] == 1, hits=Hits(found))
