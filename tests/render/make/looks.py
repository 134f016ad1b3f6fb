"""The cases of lights, textures and opacity."""
from asset import case, matt, pbr, textured
from files import holes, letters, png, pyramids

LIT = "size=48x48 spp=9 env-color=1,1,1"



def on_ground(asset):
    asset.node(mesh=asset.ground())
    asset.node(mesh=asset.mesh(asset.quad(matt(0.9, 0.6, 0.3), (-0.5, -1), (0.5, 0.2), -0.8)))
    asset.camera((0, 1.6, 4.5), 0.42, 0.7)


@case("light/spot", "A spot light with a soft edge on the ground, half of it cut off by a card.", "size=48x48 spp=9")
def _(a):
    on_ground(a)
    a.light({"type": "spot", "intensity": 40, "color": [1, 0.9, 0.7],
             "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}}, translation=[0.5, 2.2, 0.4],
            rotation=[-0.707107, 0, 0, 0.707107])


@case("light/point-falloff", "A lamp near the ground: light falls off by the square, and ends at the range.",
      "size=48x48 spp=9")
def _(a):
    on_ground(a)
    a.light({"type": "point", "intensity": 2.5, "range": 1.6}, translation=[0, -0.4, 0.3])


@case("light/directional", "A sun of the asset, in yellow: parallel shadows.", "size=48x48 spp=9")
def _(a):
    on_ground(a)
    a.sun()


@case("light/emissive-triangles", "Two shining triangles light the ground; one of them shines on one side alone.",
      "size=48x48 spp=64 env-color=0,0,0")
def _(a):
    on_ground(a)
    for x, color, turn in ((-1.5, [9, 5, 2], [0, 0.5, 0, 0.866025]), (1.5, [2, 5, 9], [0, -0.5, 0, 0.866025])):
        shining = pbr((0, 0, 0), 0, 1, {"emissive_strength": {"emissiveStrength": 9}},
                      emissiveFactor=[c / 9 for c in color])
        mesh = a.mesh(a.primitive([(-0.6, -0.9, 0), (0.6, -0.9, 0), (0, 0.6, 0)], [(0, 1, 2)], shining))
        a.node(mesh=mesh, translation=[x, 0, 0], rotation=turn)


@case("light/studio", "An asset without any light stands in the studio.", "size=48x48 spp=16 finds=RD003")
def _(a):
    on_ground(a)


def shining(strength, color=(1, 1, 1)):
    return pbr((0, 0, 0), 0, 1, {"emissive_strength": {"emissiveStrength": strength}}, emissiveFactor=list(color))


def card(asset, material, low, high, z=0.0):
    asset.node(mesh=asset.mesh(asset.quad(material, low, high, z)))


@case("light/leaf", "One leaf that shines, behind a dark island, which its light hardly shows.",
      "size=48x48 spp=64")
def _(a):
    card(a, matt(0.04, 0.05, 0.04), (-1.6, -1), (1.6, 0.2))
    card(a, matt(0.05, 0.03, 0.02), (-0.2, 0.2), (0.2, 1))
    card(a, shining(30, (0.4, 1, 0.2)), (0.3, 0.5), (0.6, 0.8), -0.4)
    a.camera()


@case("light/labels", "A dark board with white labels that shine, too little to count as light.", "size=48x48 spp=16 finds=RD003")
def _(a):
    card(a, pbr((0.06, 0.07, 0.09), 0, 0.5), (-1.2, -1), (1.2, 1))
    for k in range(3):
        card(a, shining(1), (-1, 0.55 - 0.6 * k), (-0.2, 0.7 - 0.6 * k), 0.01)
    a.camera()


@case("light/strengths", "Five lamps on a wall, each twice as strong as the one before it.", "size=48x48 spp=64")
def _(a):
    card(a, matt(0.4, 0.4, 0.4), (-1.2, -1), (1.2, 1))
    for k in range(5):
        card(a, shining(2 ** k, (0.2, 0.5, 1)), (-1.05 + 0.44 * k, -0.15), (-0.75 + 0.44 * k, 0.15), 0.1)
    a.camera()


# Textures.

def quads(asset, materials, uv=((0, 1), (1, 1), (1, 0), (0, 0)), **more):
    places = [(-1.1, 0.05), (0.05, 0.05), (-1.1, -1.1), (0.05, -1.1)]
    for material, (x, y) in zip(materials, places):
        asset.node(mesh=asset.mesh(asset.quad(material(asset), (x, y), (x + 1.05, y + 1.05), uv=uv, **more)))
    asset.camera()


@case("texture/wrap", "Beyond its edges a picture is repeated, mirrored, held, or each along one axis.", LIT)
def _(a):
    wrap = {"repeat": 10497, "mirror": 33648, "clamp": 33071}
    pairs = [("repeat", "repeat"), ("mirror", "mirror"), ("clamp", "clamp"), ("repeat", "mirror")]
    quads(a, [textured({"magFilter": 9729, "wrapS": wrap[s], "wrapT": wrap[t]}) for s, t in pairs],
          ((-0.7, 1.7), (1.7, 1.7), (1.7, -0.7), (-0.7, -0.7)))


@case("texture/filter", "A few texels by nearest and by linear filter.", LIT)
def _(a):
    near = ((0.25, 0.6), (0.6, 0.6), (0.6, 0.25), (0.25, 0.25))
    quads(a, [textured({"magFilter": f}) for f in (9728, 9729)], near)


@case("texture/transform", "Coordinates as they are, moved, turned and scaled.", LIT)
def _(a):
    a.use("KHR_texture_transform")
    moves = [{}, {"offset": [0.3, 0]}, {"rotation": 0.6}, {"scale": [2, 3]}]
    quads(a, [textured(None, extensions={"KHR_texture_transform": move}) for move in moves])


@case("texture/second-uv", "Two sets of coordinates: the second, mirrored, shows the picture to the right.", LIT)
def _(a):
    mirrored = [(1, 1), (0, 1), (0, 0), (1, 0)]
    for x, texcoord in ((-1.1, 0), (0.05, 1)):
        material = textured(None, texCoord=texcoord)(a)
        a.node(mesh=a.mesh(a.quad(material, (x, -0.5), (x + 1.05, 0.55), TEXCOORD_1=mirrored)))
    a.camera()


@case("texture/vertex-colors", "Colours of corners, mixed between them, times a picture to the right.", LIT)
def _(a):
    colors = [(1, 0.1, 0.1), (0.1, 1, 0.1), (0.1, 0.1, 1), (1, 1, 0.2)]
    for x, material in ((-1.1, matt(1, 1, 1)), (0.05, textured(None)(a))):
        a.node(mesh=a.mesh(a.quad(material, (x, -0.5), (x + 1.05, 0.55), COLOR_0=colors)))
    a.camera()


@case("texture/normal-scale", "Pyramids of scale 0, 0.5, 1 and 2 under a sun.", "size=48x48 spp=9")
def _(a):
    def material(scale):
        return lambda a: matt(0.8, 0.7, 0.6, normalTexture={"index": a.image(png(32, 32, pyramids)), "scale": scale})
    quads(a, [material(s) for s in (0, 0.5, 1, 2)], TANGENT=[(1, 0, 0, 1)] * 4)
    a.sun()


# Opacity.

@case("alpha/mask", "Texels below the cut-off are holes: cut-offs of 0.2 and 0.7; light falls through them.",
      "size=48x48 spp=9")
def _(a):
    for x, cutoff in ((-1.1, 0.2), (0.05, 0.7)):
        card = matt(1, 1, 1, alphaMode="MASK", alphaCutoff=cutoff, doubleSided=True)
        card["pbrMetallicRoughness"]["baseColorTexture"] = {"index": a.image(png(16, 16, holes), {"magFilter": 9728})}
        a.node(mesh=a.mesh(a.quad(card, (x, -0.9), (x + 1.05, 0.15), 0.5)))
    a.node(mesh=a.ground())
    a.camera((0, 1, 4), 0.3)
    a.sun()


@case("alpha/blend", "Three half-opaque cards, one behind another; each shows those behind it.",
      "size=48x48 spp=64 env-color=1,1,1")
def _(a):
    for k, color in enumerate(([1, 0.1, 0.1, 0.5], [0.1, 1, 0.1, 0.5], [0.1, 0.1, 1, 0.5])):
        card = {"pbrMetallicRoughness": {"baseColorFactor": color, "metallicFactor": 0, "roughnessFactor": 1},
                "alphaMode": "BLEND"}
        low = (-1 + 0.4 * k, -1 + 0.4 * k)
        a.node(mesh=a.mesh(a.quad(card, low, (low[0] + 1.2, low[1] + 1.2), -0.3 * k)))
    a.camera()


@case("alpha/blend-texture", "The opacity of texels: opaque, none and half, before stripes.",
      "size=48x48 spp=64 env-color=1,1,1")
def _(a):
    card = matt(1, 1, 1, alphaMode="BLEND")
    card["pbrMetallicRoughness"]["baseColorTexture"] = {"index": a.image(png(16, 16, holes), {"magFilter": 9728})}
    a.node(mesh=a.mesh(a.quad(card, (-0.9, -0.9), (0.9, 0.9))))
    colors = ((0.1, 0.15, 0.4), (0.9, 0.85, 0.7))
    stripes = [a.quad(matt(*colors[k % 2]), (-2.5, k / 4), (2.5, k / 4 + 0.25), -1.0) for k in range(-7, 7)]
    a.node(mesh=a.mesh(*stripes))
    a.camera()


@case("alpha/opaque", "An opacity in a texture counts for nothing if the material is opaque.", LIT)
def _(a):
    card = matt(1, 1, 1)
    card["pbrMetallicRoughness"]["baseColorTexture"] = {"index": a.image(png(16, 16, holes), {"magFilter": 9728})}
    a.node(mesh=a.mesh(a.quad(card, (-0.9, -0.9), (0.9, 0.9))))
    a.camera()


@case("alpha/back-faces", "Cards seen from behind: the one-sided one to the left is not seen but casts its shadow.",
      "size=48x48 spp=9")
def _(a):
    for x, double in ((-1.1, False), (0.1, True)):
        card = matt(0.9, 0.4, 0.2, doubleSided=double)
        mesh = a.mesh(a.quad(card, (-0.45, -0.9), (0.45, 0.1)))
        a.node(mesh=mesh, translation=[x + 0.5, 0, 0], rotation=[0, 1, 0, 0])
    a.node(mesh=a.ground())
    a.camera((0, 1, 4), 0.3)
    a.sun()


@case("alpha/coverage", "Half-opaque cards before nothing: the picture is transparent behind them.",
      "size=48x48 spp=64 env-color=1,1,1 background=transparent")
def _(a):
    for k, alpha in enumerate((0.25, 0.5, 0.75)):
        card = {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.4, 0.1, alpha], "metallicFactor": 0,
                                         "roughnessFactor": 1}, "alphaMode": "BLEND"}
        a.node(mesh=a.mesh(a.quad(card, (-1.1 + 0.6 * k, -0.9), (-0.3 + 0.6 * k, 0.9), -0.3 * k)))
    a.camera()
