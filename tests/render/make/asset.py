"""A glTF asset put together part by part, and the cases made so."""
import base64
import json
import math
import struct

from files import ball, letters, png


class Asset:
    """Collects a glTF asset. Data that many assets share lies in a file of its own, all else in `data:`."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0", "generator": "tests/render/make"}}
        self.bytes = b""
        self.shared = None

    def add(self, kind, part):
        self.json.setdefault(kind, []).append(part)
        return len(self.json[kind]) - 1

    def view(self, data):
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        at = len(self.bytes)
        self.bytes += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": at, "byteLength": len(data)})

    def floats(self, rows):
        rows = [row if isinstance(row, tuple) else (row,) for row in rows]
        width = len(rows[0])
        data = struct.pack(f"<{width * len(rows)}f", *(c for row in rows for c in row))
        single = [struct.unpack(f"<{width}f", data[4 * width * k:4 * width * (k + 1)]) for k in range(len(rows))]
        kind = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}[width]
        accessor = {"bufferView": self.view(data), "componentType": 5126, "type": kind, "count": len(rows)}
        if width in (1, 3):
            accessor["min"] = [min(row[k] for row in single) for k in range(width)]
            accessor["max"] = [max(row[k] for row in single) for k in range(width)]
        return self.add("accessors", accessor)

    def shorts(self, rows):
        flat = [c for row in rows for c in (row if isinstance(row, tuple) else (row,))]
        data = struct.pack(f"<{len(flat)}H", *flat)
        return self.add("accessors", {"bufferView": self.view(data), "componentType": 5123, "type": "SCALAR",
                                      "count": len(flat)})

    def primitive(self, corners, triangles, material, **attributes):
        found = {"POSITION": self.floats(corners)}
        for name, rows in attributes.items():
            found[name] = self.floats(rows)
        part = {"attributes": found, "indices": self.shorts(triangles)}
        if material is not None:
            part["material"] = self.material(material)
        return part

    def material(self, material):
        for name in material.get("extensions", {}):
            self.use(name)
        return self.add("materials", material)

    def use(self, extension):
        used = self.json.setdefault("extensionsUsed", [])
        if extension not in used:
            used.append(extension)

    def mesh(self, *primitives, **more):
        return self.add("meshes", {"primitives": list(primitives), **more})

    def node(self, **node):
        index = self.add("nodes", node)
        self.json.setdefault("scenes", [{"nodes": []}])[0]["nodes"].append(index)
        self.json["scene"] = 0
        return index

    def quad(self, material, low, high, z=0.0, uv=((0, 1), (1, 1), (1, 0), (0, 0)), **more):
        (x0, y0), (x1, y1) = low, high
        corners = [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)]
        return self.primitive(corners, [(0, 1, 2), (0, 2, 3)], material, NORMAL=[(0, 0, 1)] * 4,
                              TEXCOORD_0=[tuple(p) for p in uv], **more)

    def ground(self, color=(0.5, 0.55, 0.6), y=-1.0, size=6.0):
        corners = [(-size, y, size), (size, y, size), (size, y, -size), (-size, y, -size)]
        return self.mesh(self.primitive(corners, [(0, 1, 2), (0, 2, 3)], matt(*color), NORMAL=[(0, 1, 0)] * 4))

    def image(self, data, sampler=None):
        uri = "data:image/png;base64," + base64.b64encode(data).decode()
        texture = {"source": self.add("images", {"uri": uri})}
        if sampler is not None:
            texture["sampler"] = self.add("samplers", sampler)
        return self.add("textures", texture)

    def camera(self, eye=(0, 0, 4), down=0.0, yfov=0.62, **more):
        """A camera that looks along -z, turned down by an angle."""
        own = more or {"type": "perspective", "perspective": {"yfov": yfov, "aspectRatio": 1, "znear": 0.1}}
        turn = [-math.sin(down / 2), 0, 0, math.cos(down / 2)]
        return self.node(camera=self.add("cameras", own), translation=list(eye),
                         rotation=[round(c, 6) + 0.0 for c in turn])

    def light(self, light, **node):
        self.use("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(light)
        return self.node(extensions={"KHR_lights_punctual": {"light": len(lights) - 1}}, **node)

    def sun(self, intensity=3.0):
        """From the left, above and before: -z turned by 45 degrees about x, then by -35 about y."""
        x, y = math.radians(-45) / 2, math.radians(-35) / 2
        turn = [math.cos(y) * math.sin(x), math.sin(y) * math.cos(x), -math.sin(y) * math.sin(x),
                math.cos(y) * math.cos(x)]
        self.light({"type": "directional", "intensity": intensity}, rotation=[round(c, 6) for c in turn])

    def finish(self, shows, options):
        self.json["asset"]["extras"] = {"shows": shows, "options": options}
        if self.bytes:
            uri = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
            self.json["buffers"] = [{"byteLength": len(self.bytes), "uri": uri}]
        if self.shared:
            # The shared data is the last buffer.
            buffers = self.json.setdefault("buffers", [])
            for view in self.json["bufferViews"]:
                view["buffer"] = view.pop("shared", None) is not None and len(buffers) or view["buffer"]
            buffers.append(self.shared)
        return self.json


def matt(r, g, b, **more):
    return {"pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1], "metallicFactor": 0, "roughnessFactor": 1},
            **more}


def pbr(color=(0.8, 0.8, 0.8), metal=0, rough=0.4, extensions=None, **more):
    material = {"pbrMetallicRoughness": {"baseColorFactor": list(color) + [1], "metallicFactor": metal,
                                         "roughnessFactor": rough}, **more}
    if extensions:
        material["extensions"] = {"KHR_materials_" + name: value for name, value in extensions.items()}
    return material


def textured(sampler, **info):
    return lambda a: {"pbrMetallicRoughness": {"baseColorTexture": {
        "index": a.image(png(16, 16, letters), sampler), **info}, "metallicFactor": 0, "roughnessFactor": 1}}


AROUND, RINGS = 32, 16


def ball_file():
    corners, uvs, triangles = ball(AROUND, RINGS)
    data = struct.pack(f"<{3 * len(corners)}f", *(c for row in corners for c in row))
    data += struct.pack(f"<{2 * len(uvs)}f", *(c for row in uvs for c in row))
    data += struct.pack(f"<{3 * len(triangles)}H", *(k for row in triangles for k in row))
    tangents = [(math.cos(2 * math.pi * u), 0, -math.sin(2 * math.pi * u), 1) for u, _ in uvs]
    return data + struct.pack(f"<{4 * len(uvs)}f", *(c for row in tangents for c in row))


def shared_ball(asset, tangents):
    """The accessors of files/ball.bin: corners, which are normals too, uvs, triangles, and tangents."""
    corners, uvs, triangles = ball(AROUND, RINGS)
    sizes = [12 * len(corners), 8 * len(uvs), 6 * len(triangles), 16 * len(uvs)]
    asset.shared = {"byteLength": sum(sizes), "uri": "files/ball.bin"}
    views = [asset.add("bufferViews", {"buffer": 0, "shared": True, "byteOffset": sum(sizes[:k]), "byteLength": size})
             for k, size in enumerate(sizes[:4 if tangents else 3])]
    limit = {"min": [-1, -1, -1], "max": [1, 1, 1]}
    place = asset.add("accessors", {"bufferView": views[0], "componentType": 5126, "type": "VEC3",
                                    "count": len(corners), **limit})
    uv = asset.add("accessors", {"bufferView": views[1], "componentType": 5126, "type": "VEC2", "count": len(uvs)})
    index = asset.add("accessors", {"bufferView": views[2], "componentType": 5123, "type": "SCALAR",
                                    "count": 3 * len(triangles)})
    attributes = {"POSITION": place, "NORMAL": place, "TEXCOORD_0": uv}
    if tangents:
        attributes["TANGENT"] = asset.add("accessors", {"bufferView": views[3], "componentType": 5126, "type": "VEC4",
                                                        "count": len(uvs)})
    return {"attributes": attributes, "indices": index}


CASES = {}


def case(name, shows, options):
    """Registers a function that fills an asset as a case."""
    def register(fill):
        def made():
            asset = Asset()
            fill(asset)
            return asset.finish(shows, options)
        CASES[name] = made
        return fill
    return register


def glb(asset):
    """The asset as a binary file, its images in the same chunk as its other data."""
    (buffer,) = asset["buffers"]
    data = base64.b64decode(buffer.pop("uri").split(",")[1])
    for image in asset["images"]:
        picture = base64.b64decode(image.pop("uri").split(",")[1])
        data += b"\0" * (-len(data) % 4)
        asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(picture)})
        image.update(bufferView=len(asset["bufferViews"]) - 1, mimeType="image/png")
        data += picture
    data += b"\0" * (-len(data) % 4)
    buffer["byteLength"] = len(data)
    text = json.dumps(asset, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def text(asset):
    """The asset as text, a line for each of its parts."""
    def lines(value):
        if not isinstance(value, list):
            return json.dumps(value)
        parts = ",\n  ".join(json.dumps(part) for part in value)
        return f"[\n  {parts}]"
    return ("{" + ",\n ".join(f'"{key}": {lines(value)}' for key, value in asset.items()) + "}\n").encode()
