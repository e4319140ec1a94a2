"""The cases of plugins.py that are BSDFs: one line each."""

from plugin_scenes import Case, Spectrum, Transform, balls_and_card, bsdf, integrator, texture

GREY = texture.bitmap(filename="grey.png", raw=True)
PAINT = texture.bitmap(filename="paint.png")
HEIGHTS = texture.bitmap(filename="heights.png", raw=True)
WIDE_HEIGHTS = texture.bitmap(filename="wide_heights.png", raw=True, to_uv=Transform("scale 2 1 1"))
NORMALS = texture.bitmap(filename="normals.png", raw=True)
RED, BLUE = bsdf.diffuse(reflectance=(0.7, 0.2, 0.1)), bsdf.diffuse(reflectance=(0.1, 0.2, 0.7))
GOLD = bsdf.roughconductor(material="Au", alpha=0.2)

SIMPLE = [
    bsdf.diffuse(),
    bsdf.diffuse(reflectance=(0.2, 0.5, 0.8)),
    bsdf.diffuse(reflectance=PAINT),
    bsdf.twosided(RED),
    bsdf.twosided(RED, BLUE),
    bsdf.twosided(bsdf.plastic(), GOLD),
    bsdf.twosided(bsdf.twosided(RED)),
    bsdf.twosided(bsdf.twosided(RED, BLUE)),
    bsdf.twosided(bsdf.dielectric(), allow_transmission=True),
    bsdf.conductor(),
    bsdf.conductor(material="Cu"),
    bsdf.conductor(eta=1.5, k=2.0),
    bsdf.conductor(eta=(0.2, 0.9, 1.1), k=(3.9, 2.5, 2.1), specular_reflectance=(0.9, 0.7, 0.5)),
    bsdf.conductor(eta=Spectrum("400:1.6, 500:1.0, 600:0.3, 700:0.2"), k=Spectrum("400:1.9, 500:1.9, 600:2.9, 700:3.9")),
    bsdf.conductor(specular_reflectance=PAINT),
    *(bsdf.roughconductor(material=m, alpha=0.15) for m in ("Ag", "Al", "Cr", "W", "Cu2O", "TiN", "none")),
    *(bsdf.roughconductor(distribution=d, alpha=a, material="Au") for d in ("ggx", "beckmann") for a in (0.02, 0.1, 0.5, 1.0)),
    *(bsdf.roughconductor(distribution=d, alpha_u=0.05, alpha_v=0.4) for d in ("ggx", "beckmann")),
    bsdf.roughconductor(alpha_u=0.4, alpha_v=0.1, specular_reflectance=(0.9, 0.6, 0.3)),
    bsdf.roughconductor(alpha=GREY, specular_reflectance=PAINT),
    bsdf.roughconductor(alpha_u=GREY, alpha_v=0.2, distribution="ggx"),
    bsdf.roughconductor(alpha=0.3, sample_visible=False),
    bsdf.roughconductor(alpha=0.3, sample_visible=False, distribution="ggx"),
    bsdf.roughconductor(eta=(0.2, 0.9, 1.1), k=(3.9, 2.5, 2.1)),
    bsdf.plastic(),
    bsdf.plastic(diffuse_reflectance=(0.7, 0.4, 0.1), nonlinear=True),
    bsdf.plastic(diffuse_reflectance=PAINT, specular_reflectance=0.5, nonlinear=True),
    bsdf.plastic(int_ior="diamond", ext_ior="water"),
    bsdf.plastic(int_ior=1.2, ext_ior=1.0, specular_reflectance=(0.2, 0.5, 0.9)),
    bsdf.roughplastic(),
    bsdf.roughplastic(alpha=0.3, nonlinear=True, diffuse_reflectance=(0.8, 0.3, 0.1)),
    bsdf.roughplastic(distribution="ggx", alpha=0.2, diffuse_reflectance=PAINT, specular_reflectance=(0.9, 0.6, 0.3)),
    bsdf.roughplastic(int_ior="diamond", ext_ior="water", alpha=0.4, nonlinear=True),
    bsdf.roughplastic(int_ior=1.9, alpha=0.05, distribution="ggx"),
    bsdf.roughplastic(alpha=0.3, sample_visible=False),
    bsdf.roughplastic(specular_reflectance=GREY, alpha=0.2),
]

CLEAR = [
    bsdf.dielectric(),
    bsdf.dielectric(int_ior="diamond", ext_ior="air"),
    bsdf.dielectric(int_ior="water", ext_ior=1.6),
    bsdf.dielectric(int_ior=1.0, ext_ior=1.0),
    bsdf.dielectric(specular_reflectance=(0.9, 0.5, 0.2), specular_transmittance=(0.3, 0.7, 0.9)),
    bsdf.dielectric(specular_transmittance=PAINT),
    bsdf.thindielectric(),
    bsdf.thindielectric(int_ior=2.2, ext_ior="water", specular_reflectance=0.7, specular_transmittance=(0.4, 0.9, 0.6)),
    *(bsdf.roughdielectric(distribution=d, alpha=a) for d in ("ggx", "beckmann") for a in (0.05, 0.3, 0.8)),
    bsdf.roughdielectric(alpha_u=0.1, alpha_v=0.4, distribution="ggx"),
    bsdf.roughdielectric(alpha=0.2, int_ior="water", ext_ior="diamond"),
    bsdf.roughdielectric(alpha=0.2, specular_reflectance=(0.9, 0.5, 0.2), specular_transmittance=PAINT),
    bsdf.roughdielectric(alpha=GREY, distribution="ggx"),
    bsdf.roughdielectric(alpha=0.3, sample_visible=False),
]

MAPS = [
    bsdf.bumpmap(HEIGHTS, RED),
    bsdf.bumpmap(HEIGHTS, RED, scale=8.0),
    bsdf.bumpmap(HEIGHTS, RED, scale=-5.0, flip_invalid_normals=False),
    bsdf.bumpmap(HEIGHTS, GOLD, scale=4.0, use_shadowing_function=False),
    bsdf.bumpmap(WIDE_HEIGHTS, bsdf.twosided(bsdf.roughplastic(alpha=0.2)), scale=4.0),
    bsdf.bumpmap(HEIGHTS, bsdf.roughconductor(alpha_u=0.05, alpha_v=0.4), scale=4.0),
    bsdf.bumpmap(HEIGHTS, bsdf.dielectric(), scale=3.0),
    bsdf.bumpmap(texture.bitmap(filename="heights.png", raw=True, filter_type="nearest"), RED, scale=4.0),
    bsdf.twosided(bsdf.bumpmap(HEIGHTS, RED, scale=5.0)),
    bsdf.normalmap(RED, normalmap=NORMALS),
    bsdf.normalmap(GOLD, normalmap=NORMALS, flip_invalid_normals=False),
    bsdf.normalmap(RED, normalmap=NORMALS, use_shadowing_function=False),
    bsdf.normalmap(bsdf.roughconductor(alpha_u=0.05, alpha_v=0.4), normalmap=NORMALS),
    bsdf.normalmap(bsdf.roughdielectric(alpha=0.2), normalmap=NORMALS),
    bsdf.twosided(bsdf.normalmap(bsdf.plastic(), normalmap=NORMALS)),
    bsdf.normalmap(bsdf.bumpmap(HEIGHTS, RED, scale=3.0), normalmap=NORMALS),
    bsdf.blendbsdf(RED, GOLD, weight=0.3),
    bsdf.blendbsdf(RED, bsdf.roughplastic(), weight=GREY),
    bsdf.twosided(bsdf.blendbsdf(RED, BLUE, weight=GREY)),
    bsdf.blendbsdf(bsdf.twosided(RED), bsdf.roughdielectric(alpha=0.3), weight=0.6),
    bsdf.blendbsdf(bsdf.conductor(), bsdf.dielectric(), weight=0.4),
    bsdf.blendbsdf(bsdf.blendbsdf(RED, BLUE, weight=0.5), GOLD, weight=GREY),
    bsdf.blendbsdf(RED, BLUE, weight=texture.checkerboard(color0=0.1, color1=0.9, to_uv=Transform("scale 4"))),
]

PARTLY = [
    bsdf.null(),
    bsdf.mask(RED),
    bsdf.mask(bsdf.twosided(GOLD), opacity=0.3),
    bsdf.mask(bsdf.twosided(RED), opacity=GREY),
    bsdf.mask(bsdf.twosided(RED), opacity=texture.bitmap(filename="paint.png")),
    bsdf.mask(bsdf.dielectric(), opacity=0.7),
    bsdf.blendbsdf(bsdf.null(), bsdf.twosided(BLUE), weight=0.6),
    bsdf.blendbsdf(bsdf.twosided(BLUE), bsdf.null(), weight=GREY),
    bsdf.twosided(bsdf.mask(RED, opacity=0.4), allow_transmission=True),
    bsdf.mask(bsdf.twosided(RED), opacity=texture.checkerboard(color0=0.2, color1=1.0, to_uv=Transform("scale 3"))),
]

TINT = (0.7, 0.3, 0.15)
PRINCIPLED = [
    bsdf.principled(),
    bsdf.principled(base_color=TINT, roughness=0.1),
    bsdf.principled(base_color=PAINT, roughness=GREY),
    bsdf.principled(base_color=TINT, roughness=0.3, anisotropic=0.8),
    bsdf.principled(base_color=TINT, metallic=1.0, roughness=0.3),
    bsdf.principled(base_color=TINT, metallic=GREY, roughness=0.4, anisotropic=0.5),
    bsdf.principled(base_color=TINT, eta=1.9),
    bsdf.principled(base_color=TINT, specular=0.9, roughness=0.2),
    bsdf.principled(base_color=TINT, specular=0.0),
    bsdf.principled(base_color=TINT, spec_tint=0.8, roughness=0.2),
    bsdf.principled(base_color=TINT, spec_tint=GREY, metallic=0.3),
    bsdf.principled(base_color=TINT, sheen=0.9),
    bsdf.principled(base_color=TINT, sheen=GREY, sheen_tint=0.7),
    bsdf.principled(base_color=TINT, flatness=0.8),
    bsdf.principled(base_color=TINT, flatness=GREY),
    bsdf.principled(base_color=TINT, clearcoat=1.0),
    bsdf.principled(base_color=TINT, clearcoat=GREY, clearcoat_gloss=0.9),
    bsdf.principled(base_color=TINT, clearcoat=0.8, clearcoat_gloss=0.2, metallic=0.8),
    bsdf.principled(base_color=TINT, spec_trans=1.0, roughness=0.2, eta=1.4),
    bsdf.principled(base_color=TINT, spec_trans=0.6, roughness=0.4, specular=0.5),
    bsdf.principled(base_color=TINT, spec_trans=GREY, roughness=0.3, spec_tint=0.5),
    bsdf.principled(base_color=TINT, spec_trans=0.5, roughness=0.3, anisotropic=0.7, sheen=0.4, clearcoat=0.5, flatness=0.3, metallic=0.2),
    bsdf.principled(main_specular_sampling_rate=0.4, clearcoat_sampling_rate=2.0, diffuse_reflectance_sampling_rate=3.0, clearcoat=0.5),
    bsdf.twosided(bsdf.principled(base_color=TINT, roughness=0.3)),
    bsdf.principledthin(),
    bsdf.principledthin(base_color=TINT, roughness=0.15),
    bsdf.principledthin(base_color=TINT, roughness=GREY, anisotropic=0.8, spec_trans=0.5),
    bsdf.principledthin(base_color=TINT, spec_trans=1.0, roughness=0.3, eta=1.8),
    bsdf.principledthin(base_color=PAINT, spec_trans=GREY, spec_tint=0.7),
    bsdf.principledthin(base_color=TINT, sheen=0.8, sheen_tint=0.5),
    bsdf.principledthin(base_color=TINT, flatness=0.9),
    bsdf.principledthin(base_color=TINT, diff_trans=1.2),
    bsdf.principledthin(base_color=TINT, diff_trans=GREY, flatness=0.4, sheen=0.3, spec_trans=0.3, roughness=0.2),
    bsdf.principledthin(specular_reflectance_sampling_rate=0.4, specular_transmittance_sampling_rate=2.0, spec_trans=0.5,
                        diffuse_transmittance_sampling_rate=3.0, diffuse_reflectance_sampling_rate=0.5),
]


def cases():
    for group, materials in (("simple", SIMPLE), ("clear", CLEAR), ("maps", MAPS), ("principled", PRINCIPLED)):
        for material in materials:
            yield Case("bsdf", repr(material), balls_and_card(material))
    # A passage through a mask counts as a vertex in Mitsuba: no limit tells that apart.
    for material in PARTLY:
        yield Case("bsdf", repr(material), balls_and_card(material), parts={"integrator": integrator.path(max_depth=-1, rr_depth=50)})
