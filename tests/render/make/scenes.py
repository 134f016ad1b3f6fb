"""The cases of cameras, and of what an asset may hold."""
import math
import struct

from asset import case, matt, textured

LIT = "size=48x48 spp=9 env-color=1,1,1"


def row(asset):
    for k, color in enumerate(((0.9, 0.2, 0.2), (0.3, 0.8, 0.3), (0.2, 0.4, 0.9))):
        card = asset.quad(matt(*color), (-1.2 + 0.7 * k, -1), (-0.6 + 0.7 * k, 0.4), 0.8 - 1.6 * k)
        asset.node(mesh=asset.mesh(card))
    asset.node(mesh=asset.ground())
    asset.sun()


ORTHO = {"type": "orthographic", "orthographic": {"xmag": 1.5, "ymag": 1.5, "znear": 0.1, "zfar": 100}}


@case("camera/orthographic", "Cards of one size stay of one size, however far away.", "size=48x48 spp=9")
def _(a):
    row(a)
    a.camera((0, 1, 4), 0.3, **ORTHO)


@case("camera/perspective", "The cards of orthographic.gltf through an angle of 55 degrees.", "size=48x48 spp=9")
def _(a):
    row(a)
    a.camera((0, 0.6, 3), 0.25, 0.96)


@case("camera/by-name", "The second of two cameras, which is asked for by its name.", "size=48x48 spp=9 camera=side")
def _(a):
    row(a)
    a.camera((0, 1, 4), 0.3)
    a.json["nodes"][a.node(camera=1, translation=[3.4, 0, 1.2], rotation=[0, 0.5, 0, 0.866025])]["name"] = "side"
    a.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}})


@case("camera/none", "Without a camera the asset is seen from the front, a little from the right and above.",
      "size=48x48 spp=9")
def _(a):
    for k, color in enumerate(((0.9, 0.2, 0.2), (0.3, 0.8, 0.3), (0.2, 0.4, 0.9))):
        a.node(mesh=a.mesh(a.quad(matt(*color), (-1 + 0.7 * k, -1), (-0.4 + 0.7 * k, 0.4), 0.4 * k)))
    a.sun()


# Assets.

@case("asset/hierarchy", "A card in a turned node in a scaled one, and a mirrored copy.", LIT)
def _(a):
    mesh = a.mesh(a.quad(textured(None)(a), (0, 0), (1, 1)))
    child = a.add("nodes", {"mesh": mesh, "rotation": [0, 0, 0.258819, 0.965926]})
    a.node(children=[child], scale=[1, 0.6, 1], translation=[0.1, -0.2, 0])
    other = a.add("nodes", {"mesh": mesh, "rotation": [0, 0, 0.258819, 0.965926]})
    a.node(children=[other], scale=[-1, -0.6, 1], translation=[-0.1, -0.2, 0])
    a.camera()


@case("asset/instances", "Nine instances of one card by EXT_mesh_gpu_instancing, turned and smaller step by step.", LIT)
def _(a):
    a.use("EXT_mesh_gpu_instancing")
    mesh = a.mesh(a.quad(textured(None)(a), (-0.5, -0.5), (0.5, 0.5)))
    steps = range(9)
    attributes = {
        "TRANSLATION": a.floats([(k % 3 * 0.8 - 0.8, 0.8 - k // 3 * 0.8, 0) for k in steps]),
        "ROTATION": a.floats([(0, 0, math.sin(k * 0.1), math.cos(k * 0.1)) for k in steps]),
        "SCALE": a.floats([(0.8 - k * 0.05,) * 3 for k in steps])}
    a.node(mesh=mesh, extensions={"EXT_mesh_gpu_instancing": {"attributes": attributes}})
    a.camera()


def animated(asset, path, keys, values, interpolation, **node):
    mesh = asset.mesh(asset.quad(textured(None)(asset), (-0.5, -0.5), (0.5, 0.5)))
    index = asset.node(mesh=mesh, **node)
    sampler = {"input": asset.floats(keys), "output": asset.floats(values), "interpolation": interpolation}
    asset.add("animations", {"samplers": [sampler],
                             "channels": [{"sampler": 0, "target": {"node": index, "path": path}}]})
    asset.camera()


@case("asset/animation", "A card three quarters of its way up and to the right.", LIT + " time=1.5")
def _(a):
    animated(a, "translation", [0.0, 2.0], [(-0.8, -0.8, 0), (0.8, 0.8, 0)], "LINEAR")


@case("asset/animation-turn", "A card that has turned by half of a right angle.", LIT + " time=0.5")
def _(a):
    animated(a, "rotation", [0.0, 1.0], [(0, 0, 0, 1), (0, 0, 0.707107, 0.707107)], "LINEAR", scale=[1.5, 1.5, 1])


@case("asset/morph", "A card whose right side is moved up by a morph target of weight 0.6.", LIT)
def _(a):
    part = a.quad(textured(None)(a), (-0.8, -0.8), (0.8, 0.4))
    part["targets"] = [{"POSITION": a.floats([(0, 0, 0), (0.2, 0.8, 0), (0.2, 0.8, 0), (0, 0, 0)])}]
    a.node(mesh=a.mesh(part, weights=[0.6]))
    a.camera()


@case("asset/skin", "A strip on two joints, of which the upper one is bent to the right.", LIT)
def _(a):
    rows = [(x, y / 4 - 1, 0) for y in range(9) for x in (-0.3, 0.3)]
    triangles = [t for k in range(0, 16, 2) for t in ((k, k + 1, k + 3), (k, k + 3, k + 2))]
    upper = [min(max((y + 0.5), 0), 1) for _, y, _ in rows]
    part = a.primitive(rows, triangles, textured(None)(a), NORMAL=[(0, 0, 1)] * 18,
                       TEXCOORD_0=[((x + 0.3) / 0.6, 1 - (y + 1) / 2) for x, y, _ in rows],
                       WEIGHTS_0=[(1 - w, w, 0, 0) for w in upper])
    joints = a.view(bytes(j for w in upper for j in (0, w > 0, 0, 0)))
    part["attributes"]["JOINTS_0"] = a.add("accessors", {"bufferView": joints, "componentType": 5121, "type": "VEC4",
                                                         "count": 18})
    bent = a.add("nodes", {"rotation": [0, 0, -0.382683, 0.92388]})
    root = a.node(children=[bent])
    unit = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
    a.add("skins", {"joints": [root, bent], "inverseBindMatrices": a.floats([unit, unit])})
    a.node(mesh=a.mesh(part), skin=0)
    a.camera()


@case("asset/topology", "A strip, a fan and single triangles, each in its colour.", LIT)
def _(a):
    def part(mode, corners, color):
        return {"attributes": {"POSITION": a.floats(corners)}, "mode": mode, "material": a.material(matt(*color))}
    strip = part(5, [(-1.1 + 0.3 * (k // 2), (0.3, -0.2)[k % 2], 0) for k in range(8)], (0.9, 0.3, 0.2))
    rim = [(0.4 + 0.6 * math.cos(k / 2), 0.6 + 0.5 * math.sin(k / 2), -0.1) for k in range(7)]
    fan = part(6, [(0.4, 0.6, -0.1)] + rim, (0.3, 0.8, 0.3))
    corners = [(k * 0.7 + x, y, 0) for k in range(3) for x, y in ((-1, -1), (-0.4, -1), (-0.7, -0.4))]
    single = part(4, corners, (0.3, 0.4, 0.9))
    a.node(mesh=a.mesh(strip, fan, single))
    a.camera()


@case("asset/points", "Coloured points from near: left without normals and so unlit, right with normals, lit by a sun.",
      "size=64x64 spp=16")
def _(a):
    # The first two are far off: they say how large the scene is, and so how thick the points are.
    places = [(-1, -1, 0), (1, 1, 0)] + [(0.02 * (k % 3), 0.02 * (k // 3 - 2), 0) for k in range(15)]
    own = {"POSITION": a.floats(places), "COLOR_0": a.floats([(k / 16, 1 - k / 16, 0.5) for k in range(17)])}
    material = a.material(matt(1, 1, 1))
    unlit = {"attributes": own, "mode": 0, "material": material}
    lit = {**unlit, "attributes": {**own, "NORMAL": a.floats([(0, 0, 1)] * len(places))}}
    a.node(mesh=a.mesh(unlit), translation=[-0.06, 0, 0])
    a.node(mesh=a.mesh(lit), translation=[0.02, 0, 0])
    a.sun()
    a.camera(yfov=0.03, eye=(0, 0, 5))


@case("asset/lines", "Six corners as lines, as a loop and as a strip, which its node flattens; all are as thick.",
      "size=64x64 spp=16 env-color=0.1,0.1,0.1")
def _(a):
    ring = [(math.cos(k * math.pi / 3), math.sin(k * math.pi / 3), 0) for k in range(6)]
    own = {"POSITION": a.floats(ring), "COLOR_0": a.floats([(k % 2, (k + 1) % 2, 0.25) for k in range(6)])}
    for mode, place, scale in ((1, [-1.1, 1.0, 0], 1), (2, [1.1, 1.0, 0], 1), (3, [0, -1.2, 0], 0.3)):
        mesh = a.mesh({"attributes": own, "mode": mode})
        a.node(mesh=mesh, translation=place, scale=[1, scale, 1])
    a.camera(yfov=0.8, eye=(0, 0, 5.5))


@case("asset/sparse", "A grid of corners, three of which a sparse accessor moves.", LIT)
def _(a):
    grid = [(x / 2 - 1, y / 2 - 1, 0) for y in range(5) for x in range(5)]
    cells = [y * 5 + x for y in range(4) for x in range(4)]
    uvs = [(x / 4, 1 - y / 4) for y in range(5) for x in range(5)]
    part = a.primitive(grid, [t for k in cells for t in ((k, k + 1, k + 6), (k, k + 6, k + 5))], textured(None)(a),
                       TEXCOORD_0=uvs)
    moved = struct.pack("<9f", -0.8, 0.8, 0, 0.3, 0.3, 0, 0.6, -0.9, 0)
    accessor = a.json["accessors"][part["attributes"]["POSITION"]]
    accessor["sparse"] = {"count": 3, "indices": {"bufferView": a.view(struct.pack("<3H", 0, 12, 24)),
                                                  "componentType": 5123}, "values": {"bufferView": a.view(moved)}}
    accessor.update(min=[-1, -1, 0], max=[1, 1, 0])
    a.node(mesh=a.mesh(part))
    a.camera()


@case("asset/variant", "The second of two variants: the blue card is yellow.", LIT + " variant=noon")
def _(a):
    a.use("KHR_materials_variants")
    a.json.setdefault("extensions", {})["KHR_materials_variants"] = {"variants": [{"name": "dusk"}, {"name": "noon"}]}
    part = a.quad(matt(0.1, 0.2, 0.8), (-0.9, -0.7), (0.7, 0.7))
    yellow = a.material(matt(0.9, 0.8, 0.1))
    part["extensions"] = {"KHR_materials_variants": {"mappings": [{"material": yellow, "variants": [1]}]}}
    a.node(mesh=a.mesh(part, a.quad(textured(None)(a), (0.2, -0.2), (1.1, 0.7), 0.3)))
    a.camera()


@case("asset/interpenetrating", "Two cards through each other: each is seen on its side of the line they share.", LIT)
def _(a):
    mesh = a.mesh(a.quad(textured(None)(a), (-0.9, -0.7), (0.9, 0.7)))
    a.node(mesh=mesh, rotation=[0, 0.258819, 0, 0.965926])
    a.node(mesh=a.mesh(a.quad(matt(0.3, 0.3, 0.6), (-0.9, -0.7), (0.9, 0.7))), rotation=[0, -0.258819, 0, 0.965926])
    a.camera()
