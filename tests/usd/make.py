# Writes layers with every kind of value and list by OpenUSD (PyPI: usd-core), each as text and as a
# binary file: `python3 tests/usd/make.py`. Numbers are multiples of 1/8, so that both are exact.
#
# `old` has arrays of the oldest version that is read: run it with
# `USD_WRITE_NEW_USDC_FILES_AS_VERSION=0.4.0 python3 tests/usd/make.py old`.
import random
import sys
from pathlib import Path
from pxr import Gf, Sdf, Vt

FOLDER = Path(__file__).parent
random.seed(1)


def prim(layer, name):
    return Sdf.CreatePrimInLayer(layer, "/" + name)


def attribute(owner, name, kind, value=None):
    made = Sdf.AttributeSpec(owner, name, kind)
    if value is not None:
        made.default = value
    return made


def save(layer, name):
    layer.Export(str(FOLDER / (name + ".usda")))
    layer.Export(str(FOLDER / (name + ".usdc")))


def walk(count, steps, start=0):
    """Numbers whose differences are some of `steps`."""
    numbers = [start]
    while len(numbers) < count:
        numbers.append(numbers[-1] + random.choice(steps))
    return numbers


types = Sdf.ValueTypeNames
if sys.argv[1:] == ["old"]:
    layer = Sdf.Layer.CreateAnonymous()
    old = prim(layer, "old")
    for count in [3, 40]:
        numbers = walk(count, [1, 1, 500])
        attribute(old, f"ints_{count}", types.IntArray, Vt.IntArray(numbers))
        attribute(old, f"floats_{count}", types.FloatArray, Vt.FloatArray([n / 8 for n in numbers]))
        attribute(old, f"words_{count}", types.TokenArray, Vt.TokenArray(list(map(str, numbers))))
        attribute(old, f"points_{count}", types.Point3fArray, Vt.Vec3fArray([Gf.Vec3f(n) for n in numbers]))
    attribute(old, "timed", types.IntArray)
    for time in [0.0, 1.0]:
        layer.SetTimeSample("/old.timed", time, Vt.IntArray([int(time)] * 30))
    old.payloadList.explicitItems = [Sdf.Payload("p.usda", "/p")]
    save(layer, "old")
    sys.exit()
eighths = lambda count, most=64: [random.randrange(-most, most) / 8 for _ in range(count)]

# Arrays: packed ones have 16 items or more.
layer = Sdf.Layer.CreateAnonymous()
arrays = prim(layer, "arrays")
integers = {
    "steady": lambda count: [7 * index for index in range(count)],
    "equal": lambda count: [4] * count,
    "bytes": lambda count: walk(count, [1, 1, 1, 100, -100]),
    "shorts": lambda count: walk(count, [1, 1, 20000, -20000]),
    "words": lambda count: walk(count, [1, 1, 500000, -400000]),
    "mixed": lambda count: walk(count, [0, 0, 0, 3, -3, 1000, -1000, 90000, -80000]),
}
# The grid of 23 × 23 faces whose packed indices are smaller than one in 256.
for count in [0, 1, 15, 16, 17, 529, 2116, 3000]:
    for name, made in integers.items():
        if count == 3000 and name not in ["steady", "equal"]:
            continue
        attribute(arrays, f"int_{name}_{count}", types.IntArray, Vt.IntArray(made(count)))
for name, made in integers.items():
    numbers = made(40)
    positive = [abs(number) for number in numbers]
    attribute(arrays, f"uint_{name}", types.UIntArray, Vt.UIntArray(positive))
    attribute(arrays, f"int64_{name}", types.Int64Array, Vt.Int64Array([n << 20 for n in numbers]))
    attribute(arrays, f"uint64_{name}", types.UInt64Array, Vt.UInt64Array([n << 20 for n in positive]))
attribute(arrays, "int_far", types.IntArray, Vt.IntArray([-(2**31), 2**31 - 1] * 9))
attribute(arrays, "uint_far", types.UIntArray, Vt.UIntArray([2**32 - 1, 0] * 9))
attribute(arrays, "int64_far", types.Int64Array, Vt.Int64Array([-(2**52), 2**52] * 9))
attribute(arrays, "uint64_far", types.UInt64Array, Vt.UInt64Array([2**63, 2**53] * 9))
floats = {
    "whole": [float(number) for number in walk(300, [1, 1, -5, 700])],
    "few": [random.choice([0.125, 2.5, -7.75]) for _ in range(300)],
    "many": [index / 8 + 0.125 for index in range(300)],
    "short": eighths(9),
}
for name, numbers in floats.items():
    attribute(arrays, f"half_{name}", types.HalfArray, Vt.HalfArray([n % 64 for n in numbers]))
    attribute(arrays, f"float_{name}", types.FloatArray, Vt.FloatArray(numbers))
    attribute(arrays, f"double_{name}", types.DoubleArray, Vt.DoubleArray(numbers))
attribute(arrays, "timecodes", types.TimeCodeArray, Vt.TimeCodeArray([Sdf.TimeCode(n) for n in eighths(20)]))
attribute(arrays, "bools", types.BoolArray, Vt.BoolArray([index % 3 == 0 for index in range(20)]))
attribute(arrays, "uchars", types.UCharArray, Vt.UCharArray(list(range(0, 240, 12))))
for count in [2, 20]:
    words = [f"w{index}" for index in range(count)]
    attribute(arrays, f"strings_{count}", types.StringArray, Vt.StringArray(words))
    attribute(arrays, f"tokens_{count}", types.TokenArray, Vt.TokenArray(words))
    attribute(arrays, f"assets_{count}", types.AssetArray, Sdf.AssetPathArray([Sdf.AssetPath(w) for w in words]))
vectors = {
    "int2": (types.Int2Array, Gf.Vec2i, Vt.Vec2iArray, 2),
    "int3": (types.Int3Array, Gf.Vec3i, Vt.Vec3iArray, 3),
    "int4": (types.Int4Array, Gf.Vec4i, Vt.Vec4iArray, 4),
    "half2": (types.Half2Array, Gf.Vec2h, Vt.Vec2hArray, 2),
    "half3": (types.Half3Array, Gf.Vec3h, Vt.Vec3hArray, 3),
    "half4": (types.Half4Array, Gf.Vec4h, Vt.Vec4hArray, 4),
    "float2": (types.Float2Array, Gf.Vec2f, Vt.Vec2fArray, 2),
    "float3": (types.Float3Array, Gf.Vec3f, Vt.Vec3fArray, 3),
    "float4": (types.Float4Array, Gf.Vec4f, Vt.Vec4fArray, 4),
    "double2": (types.Double2Array, Gf.Vec2d, Vt.Vec2dArray, 2),
    "double3": (types.Double3Array, Gf.Vec3d, Vt.Vec3dArray, 3),
    "double4": (types.Double4Array, Gf.Vec4d, Vt.Vec4dArray, 4),
}
single = {
    "int2": types.Int2, "int3": types.Int3, "int4": types.Int4,
    "half2": types.Half2, "half3": types.Half3, "half4": types.Half4,
    "float2": types.Float2, "float3": types.Float3, "float4": types.Float4,
    "double2": types.Double2, "double3": types.Double3, "double4": types.Double4,
}
values = prim(layer, "values")
for name, (kind, one, many, width) in vectors.items():
    made = lambda: one(*(map(int, eighths(width, 400)) if "int" in name else eighths(width)))
    attribute(arrays, name, kind, many([made() for _ in range(17)]))
    # Small integers stand in the place of an offset.
    attribute(values, f"{name}_small", single[name], one(*[3, -5, 100, -128][:width]))
    attribute(values, f"{name}_large", single[name], one(*[300, -500, 1000, -1024][:width]))
    if "int" not in name:
        attribute(values, f"{name}_parts", single[name], made())
for name, kind, one in [
    ("quath", types.Quath, Gf.Quath), ("quatf", types.Quatf, Gf.Quatf), ("quatd", types.Quatd, Gf.Quatd)
]:
    attribute(values, name, kind, one(0.5, 1.5, -2.5, 3.5))
quaternions = [Gf.Quatf(*eighths(4)) for _ in range(17)]
attribute(arrays, "quatfs", types.QuatfArray, Vt.QuatfArray(quaternions))
for name, kind, one, side in [
    ("matrix2d", types.Matrix2d, Gf.Matrix2d, 2),
    ("matrix3d", types.Matrix3d, Gf.Matrix3d, 3),
    ("matrix4d", types.Matrix4d, Gf.Matrix4d, 4),
]:
    attribute(values, f"{name}_diagonal", kind, one(2.0))
    attribute(values, f"{name}_full", kind, one(*eighths(side * side)))
    attribute(values, f"{name}_large", kind, one(400.0))
attribute(arrays, "matrices", types.Matrix4dArray, Vt.Matrix4dArray([Gf.Matrix4d(*eighths(16)) for _ in range(3)]))
scalars = {
    "bool": (types.Bool, [True, False]),
    "uchar": (types.UChar, [0, 255]),
    "int": (types.Int, [0, -7, 2**31 - 1, -(2**31)]),
    "uint": (types.UInt, [0, 2**32 - 1]),
    "int64": (types.Int64, [0, -7, 2**31, -(2**52)]),
    "uint64": (types.UInt64, [0, 2**32, 2**63]),
    "half": (types.Half, [0.0, -2.125]),
    "float": (types.Float, [0.0, -2.125, 1e6]),
    "double": (types.Double, [0.0, -2.125, 2.0**40 + 0.125]),
    "timecode": (types.TimeCode, [Sdf.TimeCode(-2.125)]),
    "string": (types.String, ["", "a \"word\""]),
    "token": (types.Token, ["", "token"]),
    "asset": (types.Asset, [Sdf.AssetPath("a/b.usda")]),
}
for name, (kind, all_values) in scalars.items():
    for index, value in enumerate(all_values):
        attribute(values, f"{name}_{index}", kind, value)
attribute(values, "blocked", types.Float, Sdf.ValueBlock())
attribute(values, "unset", types.Float)
save(layer, "values")

# Values at times, which share their times or not.
layer = Sdf.Layer.CreateAnonymous()
timed = prim(layer, "timed")
for name, kind, made in [
    ("number", types.Float, lambda time: time / 8),
    ("vector", types.Double3, lambda time: Gf.Vec3d(time, -time, 0.125)),
    ("numbers", types.IntArray, lambda time: Vt.IntArray([int(time)] * 30)),
    ("points", types.Point3fArray, lambda time: Vt.Vec3fArray([Gf.Vec3f(time)] * 20)),
    ("word", types.Token, lambda time: f"at{int(time)}"),
    ("blocked", types.Float, lambda time: Sdf.ValueBlock() if time == 2 else time),
]:
    attribute(timed, name, kind)
    for time in [-1.5, 0.0, 2.0, 40.0]:
        layer.SetTimeSample(f"/timed.{name}", time, made(time))
attribute(timed, "both", types.Float, 9.0)
layer.SetTimeSample("/timed.both", 1.0, 2.0)
save(layer, "times")

# Arcs, lists, variants and what layers say of the stage.
layer = Sdf.Layer.CreateAnonymous()
layer.subLayerPaths = ["below.usda", "lower.usda"]
layer.subLayerOffsets[1] = Sdf.LayerOffset(5.0, 2.0)
layer.defaultPrim = "arcs"
layer.pseudoRoot.SetInfo("upAxis", "Z")
layer.pseudoRoot.SetInfo("metersPerUnit", 0.125)
layer.timeCodesPerSecond = 30.0
layer.framesPerSecond = 12.0
layer.startTimeCode = 3.0
arcs = prim(layer, "arcs")
arcs.specifier = Sdf.SpecifierDef
arcs.typeName = "Xform"
arcs.referenceList.prependedItems = [
    Sdf.Reference("a.usda", "/a", Sdf.LayerOffset(1.0, 0.5)),
    Sdf.Reference("", "/inner", customData={"note": "kept", "deep": {"number": 3}}),
]
arcs.referenceList.appendedItems = [Sdf.Reference("b.usda")]
arcs.referenceList.deletedItems = [Sdf.Reference("c.usda")]
arcs.payloadList.prependedItems = [Sdf.Payload("p.usda", "/p", Sdf.LayerOffset(2.0, 4.0)), Sdf.Payload("q.usda")]
arcs.inheritPathList.prependedItems = ["/class"]
arcs.specializesList.explicitItems = ["/special", "/other"]
arcs.variantSelections["look"] = "red"
arcs.variantSetNameList.prependedItems = ["look"]
looks = Sdf.VariantSetSpec(arcs, "look")
for color in ["red", "blue"]:
    variant = Sdf.VariantSpec(looks, color)
    attribute(variant.primSpec, "radius", types.Double, 2.0 if color == "red" else 3.0)
    inside = Sdf.PrimSpec(variant.primSpec, f"in_{color}", Sdf.SpecifierDef, "Sphere")
    Sdf.RelationshipSpec(inside, "target").targetPathList.explicitItems = [f"/arcs/in_{color}"]
explicit = prim(layer, "explicit")
explicit.specifier = Sdf.SpecifierDef
explicit.referenceList.explicitItems = [Sdf.Reference("a.usda", "/a")]
explicit.payloadList.explicitItems = []
explicit.SetInfo("active", False)
Sdf.CreatePrimInLayer(layer, "/class").specifier = Sdf.SpecifierClass
for name in ["zebra", "apple", "mango"]:
    Sdf.PrimSpec(arcs, name, Sdf.SpecifierDef, "Scope")
bound = Sdf.RelationshipSpec(arcs, "material:binding")
bound.targetPathList.explicitItems = ["/arcs/apple"]
bound.SetInfo("bindMaterialAs", "strongerThanDescendants")
edited = Sdf.RelationshipSpec(arcs, "edited")
edited.targetPathList.prependedItems = ["/arcs/zebra", "/arcs/apple.out"]
edited.targetPathList.appendedItems = ["/arcs/mango"]
edited.targetPathList.deletedItems = ["/arcs"]
wired = attribute(arcs, "wired", types.Float)
wired.connectionPathList.explicitItems = ["/arcs/apple.out"]
shared = attribute(arcs, "primvars:st", types.TexCoord2fArray, Vt.Vec2fArray([Gf.Vec2f(0.5)] * 3))
shared.SetInfo("interpolation", "faceVarying")
deep = layer.pseudoRoot
for index in range(60):
    deep = Sdf.PrimSpec(deep, f"deep{index}", Sdf.SpecifierDef, "Xform")
save(layer, "arcs")
