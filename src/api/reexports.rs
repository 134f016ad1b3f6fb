//! Types of other packages in this API, with examples.

/// ```
/// use rtc::{Format, Options, Tone};
///
/// // Linear light in a PNG, and in an EXR.
/// let png = Options::new().tonemap(Tone::None);
/// let exr = Options::new().format(Format::Exr);
/// # let _ = (png, exr);
/// ```
#[doc(inline)]
pub use rtc_color::Tone;

/// ```
/// use rtc::{Camera, Phong, SceneBuilder, Severity, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// builder.add(Shape::sphere([0.0; 3], -1.0), Phong::default());
/// let found = builder.build().unwrap_err();
/// assert!(found.iter().any(|found| found.severity == Severity::Error));
/// ```
#[doc(inline)]
pub use rtc_diag::Severity;

/// ```
/// use rtc::{Camera, Medium, SceneBuilder, Shape, Standard};
///
/// let smoke = Medium { sigma_s: [1.0; 3], ..Medium::default() };
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Standard::null().interior(smoke));
/// builder.medium(Medium { sigma_a: [0.01; 3], ..Medium::default() });
/// ```
#[doc(inline)]
pub use rtc_ir::Medium;

/// ```
/// use rtc::{Alpha, Standard};
///
/// let leaf = Standard::default().alpha(Alpha::Mask(0.5)).double_sided(true);
/// assert_eq!(leaf.alpha, Alpha::Mask(0.5));
/// ```
#[doc(inline)]
pub use rtc_ir::Alpha;

/// ```
/// use rtc::{Bump, Camera, Phong, SceneBuilder, Texture};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// let texture = builder.texture(Texture::rgb8(2, 1, [0, 0, 0, 255, 255, 255]));
/// let rough = Phong::default().bump(Bump { texture, height: 0.5 });
/// # let _ = rough;
/// ```
#[doc(inline)]
pub use rtc_ir::Bump;

/// ```
/// use rtc::{Filter, Texture};
///
/// let pixels = Texture::rgb8(2, 1, [0, 0, 0, 255, 255, 255]).filter(Filter::Nearest);
/// # let _ = pixels;
/// ```
#[doc(inline)]
pub use rtc_ir::Filter;

/// ```
/// use rtc::{Material, Phong, Standard};
///
/// for mut material in [Material::from(Phong::default()), Standard::default().into()] {
///     material.set_color([1.0, 0.5, 0.0]);
///     match material {
///         Material::Phong(phong) => assert_eq!(phong.color, [1.0, 0.5, 0.0]),
///         Material::Standard(standard) => assert_eq!(standard.base_color, [1.0, 0.5, 0.0, 1.0]),
///     }
/// }
/// ```
#[doc(inline)]
pub use rtc_ir::Material;

/// ```
/// use rtc::{Camera, MaterialId, Phong, SceneBuilder};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// assert_eq!(builder.material(Phong::default()), MaterialId(0));
/// ```
#[doc(inline)]
pub use rtc_ir::MaterialId;

/// ```
/// use rtc::{Camera, Mesh, MeshId, SceneBuilder};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// assert_eq!(builder.mesh(Mesh::new(&corners, &[[0, 1, 2]])), MeshId(0));
/// ```
#[doc(inline)]
pub use rtc_ir::MeshId;

/// Make one by `default` and setters: later versions may add fields.
///
/// ```
/// use rtc::Phong;
///
/// let gold = Phong::default().color([1.0, 0.8, 0.2]).kd(0.6).ks(0.5).n(40.0);
/// assert_eq!(gold.ks, 0.5);
/// ```
#[doc(inline)]
pub use rtc_ir::Phong;

/// Make one by `default` and setters: later versions may add fields.
///
/// ```
/// use rtc::Standard;
///
/// let glass = Standard::default().metallic(0.0).roughness(0.0).transmission(1.0).ior(1.5);
/// let lamp = Standard::default().base_color([0.0, 0.0, 0.0, 1.0]).emissive([8.0; 3]);
/// assert_eq!((glass.transmission, lamp.emissive), (1.0, [8.0; 3]));
/// ```
#[doc(inline)]
pub use rtc_ir::Standard;

/// ```
/// use rtc::{Camera, SceneBuilder, Texture, TextureId};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// assert_eq!(builder.texture(Texture::uv()), TextureId(0));
/// ```
#[doc(inline)]
pub use rtc_ir::TextureId;

/// ```
/// use rtc::{Camera, SceneBuilder, Standard, Texture, TextureMap};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// let texture = builder.texture(Texture::rgb8(2, 1, [0, 0, 0, 255, 255, 255]));
/// let twice = TextureMap::from(texture).texture_from_surface([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]);
/// let material = Standard::default().base_color_map(twice).emissive_map(texture);
/// # let _ = material;
/// ```
#[doc(inline)]
pub use rtc_ir::Map as TextureMap;

/// ```
/// use rtc::{Texture, Wrap};
///
/// let pixels = [0, 0, 0, 255, 255, 255];
/// let clamped = Texture::rgb8(2, 1, pixels).wrap(Wrap::Clamp, Wrap::Clamp);
/// # let _ = clamped;
/// ```
#[doc(inline)]
pub use rtc_ir::Wrap;

/// ```
/// use rtc::{Camera, EffectState, Options, Phong, SceneBuilder, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]).size(8, 8));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// let effects = builder.build().unwrap().effects(&Options::new())?;
/// let shadows = effects.iter().find(|effect| effect.name == "shadows").unwrap();
/// assert_eq!(shadows.state, EffectState::Absent);
/// # Ok::<(), rtc::Error>(())
/// ```
#[doc(inline)]
pub use rtc_plan::EffectState;

/// ```
/// use rtc::{Aov, Camera, Options, Phong, SceneBuilder, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]).size(8, 8));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// let options = Options::new().layer(Aov::Normal);
/// let picture = builder.build().unwrap().render(&options)?;
/// assert_eq!(picture.layer(Aov::Normal).unwrap().len(), 3 * 8 * 8);
/// # Ok::<(), rtc::Error>(())
/// ```
#[doc(inline)]
pub use rtc_render::Aov;
