"""The cases of tests/render/layer: materials of glTF on balls, one or four."""
from asset import case, matt, pbr, shared_ball
from files import holes, letters, parts, png, pyramids

SKY = "size=48x48 spp=16 env=files/sky.hdr"


def balls(name, shows, *materials, options=SKY, backdrop=False, images=()):
    """One ball, or four; before stripes if light gets through them."""
    def fill(asset):
        part = shared_ball(asset, "normal" in name)
        for data in images:
            asset.image(data)
        places = [(0, 0, 0, 1)] if len(materials) == 1 else [(x, y, 0, 0.5) for y in (0.53, -0.53) for x in
                                                             (-0.53, 0.53)]
        for material, (x, y, z, size) in zip(materials, places):
            mesh = asset.mesh({**part, "material": asset.material(material)})
            asset.node(mesh=mesh, translation=[x, y, z], scale=[size] * 3)
        if backdrop:
            stripes = [asset.quad(matt(*((0.9, 0.85, 0.7) if k % 2 else (0.1, 0.15, 0.4))), (k / 2, -2.5),
                                  (k / 2 + 0.5, 2.5), -2.0) for k in range(-5, 5)]
            asset.node(mesh=asset.mesh(*stripes))
        asset.camera()
    case("layer/" + name, shows, options)(fill)


balls("metal", "Smooth gold: the sky in its colour.", pbr((1, 0.76, 0.33), 1, 0.0))
balls("metal-rough", "Metal of roughness 0.1, 0.3, 0.6 and 1.", *(
    pbr((0.9, 0.7, 0.5), 1, r) for r in (0.1, 0.3, 0.6, 1)))
balls("plastic", "A dielectric of roughness 0, 0.3, 0.6 and 1 over blue.", *(pbr((0.1, 0.25, 0.7), 0, r) for r in
                                                                          (0, 0.3, 0.6, 1)))
balls("ior", "Reflections by index: 1, 1.3, 1.8 and 2.5.", *(
    pbr((0.02, 0.02, 0.02), 0, 0.05, {"ior": {"ior": i}}) for i in (1, 1.3, 1.8, 2.5)))
balls("specular", "Reflections weighed: none, half, all, and all in orange.", *(
    pbr((0.02, 0.02, 0.05), 0, 0.05, {"specular": s, "ior": {"ior": 1.8}}) for s in (
        {"specularFactor": 0}, {"specularFactor": 0.5}, {"specularFactor": 1},
        {"specularFactor": 1, "specularColorFactor": [1, 0.5, 0.1]})))
balls("clearcoat", "Rough red without a coat, with half of one, with one, and with a rough one.", *(
    pbr((0.7, 0.05, 0.05), 0, 0.9, {"clearcoat": c}) for c in (
        {"clearcoatFactor": 0}, {"clearcoatFactor": 0.5}, {"clearcoatFactor": 1},
        {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.4})), options="size=48x48 spp=64 env=files/sky.hdr")
balls("clearcoat-normal", "A coat with pyramids over smooth metal, which has none.", pbr(
    (0.9, 0.5, 0.2), 1, 0.4, {"clearcoat": {"clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0}}}),
    images=[png(64, 32, pyramids)])
balls("sheen", "Dark cloth without sheen, and with white sheen of roughness 0.2, 0.5 and 1.", *(
    pbr((0.1, 0.02, 0.1), 0, 1, {"sheen": {"sheenColorFactor": [w, w, w], "sheenRoughnessFactor": r}}) for w, r in (
        (0, 0.5), (1, 0.2), (1, 0.5), (1, 1))))
balls("transmission", "Thin walls: clear, tinted, half let through, and none.", *(
    pbr(c, 0, 0, {"transmission": {"transmissionFactor": t}}) for c, t in (
        ((1, 1, 1), 1), ((1, 0.6, 0.3), 1), ((0.9, 0.3, 0.3), 0.5), ((0.9, 0.3, 0.3), 0))), backdrop=True)
balls("transmission-rough", "Frosted thin walls of roughness 0, 0.2, 0.4 and 0.8.", *(
    pbr((1, 1, 1), 0, r, {"transmission": {"transmissionFactor": 1}}) for r in (0, 0.2, 0.4, 0.8)), backdrop=True,
    options="size=48x48 spp=36 env=files/sky.hdr")
balls("volume", "A body of glass turns the stripes around; it takes away red on long ways.", pbr((1, 1, 1), 0, 0, {
    "transmission": {"transmissionFactor": 1}, "ior": {"ior": 1.5},
    "volume": {"thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [0.3, 0.8, 0.9]}}), backdrop=True)
balls("volume-distances", "Attenuation within 4, 2, 1 and half a radius.", *(pbr((1, 1, 1), 0, 0, {
    "transmission": {"transmissionFactor": 1}, "ior": {"ior": 1.1},
    "volume": {"thicknessFactor": 1, "attenuationDistance": d, "attenuationColor": [0.9, 0.5, 0.2]}}) for d in
    (2, 1, 0.5, 0.25)), backdrop=True)
balls("dispersion", "Glass that parts colours: fringes at the edges of the stripes.", pbr((1, 1, 1), 0, 0, {
    "transmission": {"transmissionFactor": 1}, "ior": {"ior": 1.5}, "dispersion": {"dispersion": 8},
    "volume": {"thicknessFactor": 1}}), backdrop=True, options="size=48x48 spp=64 env=files/sky.hdr")
balls("iridescence", "Thin films of 200, 350, 500 and 800 nm on a dark dielectric.", *(
    pbr((0.03, 0.03, 0.03), 0, 0.15, {
    "ior": {"ior": 1.8}, "iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.4,
                                         "iridescenceThicknessMaximum": t}}) for t in
    (200, 350, 500, 800)), options="size=48x48 spp=16 env-color=3,3,3 background=0,0,0")
balls("iridescence-metal", "Thin films of 200, 350, 500 and 800 nm on metal.", *(pbr((0.7, 0.7, 0.7), 1, 0.2, {
    "iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.8, "iridescenceThicknessMaximum": t}})
    for t in (200, 350, 500, 800)))
balls("anisotropy", "Brushed metal: brushed not at all, half, wholly, and wholly at a right angle.", *(
    pbr((0.8, 0.8, 0.8), 1, 0.35, {"anisotropy": {"anisotropyStrength": s, "anisotropyRotation": r}}) for s, r in (
        (0, 0), (0.5, 0), (1, 0), (1, 1.5708))), options="size=48x48 spp=36 env=files/sky.hdr")
balls("unlit", "Unlit: colours as they are, whatever the light; the last is lit.", *(
    pbr(c, 0, 0.5, {"unlit": {}} if k < 3 else None) for k, c in enumerate(
        ((0.9, 0.2, 0.1), (0.2, 0.8, 0.2), (0.2, 0.3, 0.9), (0.2, 0.3, 0.9)))))
balls("emissive", "Light of their own: half, one, two and eight times as bright as white.", *(
    pbr((0, 0, 0), 0, 1, {"emissive_strength": {"emissiveStrength": s}} if s > 1 else None,
        emissiveFactor=[min(s, 1), 0.6 * min(s, 1), 0.2 * min(s, 1)]) for s in (0.5, 1, 2, 8)),
    options="size=48x48 spp=16 env-color=0.05,0.05,0.1")
balls("emissive-map", "A picture that shines on a ball in the dark.", pbr(
    (0, 0, 0), 0, 1, None, emissiveFactor=[1, 1, 1], emissiveTexture={"index": 0}), images=[png(16, 16, letters)],
    options="size=48x48 spp=16 env-color=0.02,0.02,0.02")
balls("metallic-roughness-map", "Metal above, plastic below, rougher around the ball.", {
    "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.6, 0.3, 1], "metallicRoughnessTexture": {"index": 0}}},
    images=[png(16, 16, parts)])
balls("specular-glossiness", "The old model: glossiness 1, 0.7, 0.4 and 0 under a coloured reflectance.", *({
    "extensions": {"KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": [0.1, 0.1, 0.4, 1], "specularFactor": [0.6, 0.5, 0.2], "glossinessFactor": g}}} for g in
    (1, 0.7, 0.4, 0)))
balls("normal-map", "Pyramids on metal, of scale 1.", pbr((0.8, 0.8, 0.8), 1, 0.2, None, normalTexture={"index": 0}),
      images=[png(64, 32, pyramids)])


@case("layer/diffuse-transmission", "Paper before a lamp and the shadow of a ball on its back: none of the light let "
      "through, half in yellow, all where a map says, and half before glass.",
      "size=48x48 spp=16 env-color=0.1,0.1,0.1")
def _(a):
    paper = {"diffuseTransmissionFactor": 0.5, "diffuseTransmissionColorFactor": [1, 0.8, 0.2]}
    by_map = {"diffuseTransmissionFactor": 1, "diffuseTransmissionTexture": {"index": a.image(png(16, 16, holes))}}
    cards = [{}, {"diffuse_transmission": paper}, {"diffuse_transmission": by_map},
             {"diffuse_transmission": paper, "transmission": {"transmissionFactor": 0.7}}]
    for k, extensions in enumerate(cards):
        x, y = k % 2 * 1.1 - 1.05, 0.05 - k // 2 * 1.1
        a.node(mesh=a.mesh(a.quad(pbr((0.2, 0.5, 0.9), 0, 0.5, extensions), (x, y), (x + 1, y + 1))))
    ball = a.mesh({**shared_ball(a, False), "material": a.material(matt(0.5, 0.5, 0.5))})
    a.node(mesh=ball, translation=[0, 0, -0.5], scale=[0.2] * 3)
    a.light({"type": "point", "intensity": 12}, translation=[0, 0, -1.5])
    a.camera()
