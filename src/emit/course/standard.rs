//! Writes the glTF material, from the table of its parameters.

use super::material::exists;
use super::{SceneWriter, quoted};
use rtc_ir::{
    Alpha, Conductor, Filter, Map, Material, MaterialId, Sampled, Scene, Standard, Texture, Wrap,
};
use rtc_math::{Medium, Microfacets, Plastic, shortest};
use rtc_tables::{camel_case, parameters};

/// Writes all parameters that are not the default; the kind of each names its method.
macro_rules! material {
    ($(
        $(#[doc = $about:literal])*
        $field:ident: $kind:ident = $default:expr, $omitted:literal;
    )*) => {
        impl<'s> SceneWriter<'s> {
            pub(super) fn standard(
                &mut self,
                key: &str,
                material: &Standard,
                scene: &'s Scene,
            ) -> Result<(), String> {
                let default = Standard::default();
                let Standard { name, $($field),* } = material;
                self.line(4, key);
                self.line(6, "type: standard");
                if !name.is_empty() {
                    self.line(6, &format!("name: {}", quoted(name)));
                }
                let mut parameters = ParameterWriter { text: self, scene, left: MOST_BLENDED };
                $(if *$field != default.$field {
                    let value = parameters.$kind($field)?;
                    parameters.text.line(6, &format!("{}: {value}", camel_case!($field)));
                })*
                Ok(())
            }
        }

        impl ParameterWriter<'_, '_> {
            /// A material as a flow map.
            fn flow(&mut self, material: &Standard) -> WrittenValue {
                let default = Standard::default();
                let Standard { name, $($field),* } = material;
                let mut text = "{type: standard".to_owned();
                if !name.is_empty() {
                    text += &format!(", name: {}", quoted(name));
                }
                $(if *$field != default.$field {
                    text += &format!(", {}: {}", camel_case!($field), self.$kind($field)?);
                })*
                Ok(text + "}")
            }
        }
    };
}

parameters!(material);

impl SceneWriter<'_> {
    /// The value of a participating medium.
    pub(super) fn medium(&mut self, medium: &Medium) -> String {
        let Medium {
            sigma_a,
            sigma_s,
            g,
        } = medium;
        let [sigma_a, sigma_s] = [sigma_a, sigma_s].map(|sigma| self.list(*sigma));
        self.finite &= g.is_finite();
        let g = shortest(*g);
        format!("{{sigmaA: {sigma_a}, sigmaS: {sigma_s}, g: {g}}}")
    }
}

/// The writer of the parameters of one material.
struct ParameterWriter<'t, 's> {
    text: &'t mut SceneWriter<'s>,
    scene: &'s Scene,
    /// How many more materials of a blend may be written.
    left: usize,
}

/// The most materials of a blend.
const MOST_BLENDED: usize = 16;

/// The text of a value, or why it can't be written.
type WrittenValue = Result<String, String>;

#[expect(
    clippy::unnecessary_wraps,
    clippy::trivially_copy_pass_by_ref,
    reason = "the rows of the table are alike"
)]
impl ParameterWriter<'_, '_> {
    fn number(&mut self, value: &f64) -> WrittenValue {
        self.text.finite &= value.is_finite();
        Ok(shortest(*value))
    }

    fn fraction(&mut self, value: &f64) -> WrittenValue {
        self.number(value)
    }

    fn non_negative(&mut self, value: &f64) -> WrittenValue {
        self.number(value)
    }

    fn ior(&mut self, value: &f64) -> WrittenValue {
        self.number(value)
    }

    fn index_of_refraction(&mut self, value: &f64) -> WrittenValue {
        self.number(value)
    }

    fn distance(&mut self, value: &Option<f64>) -> WrittenValue {
        self.number(&value.unwrap_or(f64::NAN))
    }

    fn pair(&mut self, values: &[f64; 2]) -> WrittenValue {
        Ok(self.text.list(*values))
    }

    fn color(&mut self, values: &[f64; 3]) -> WrittenValue {
        Ok(self.text.list(*values))
    }

    fn fraction_color(&mut self, values: &[f64; 3]) -> WrittenValue {
        Ok(self.text.list(*values))
    }

    fn fractions(&mut self, values: &[f64; 4]) -> WrittenValue {
        Ok(self.text.list(*values))
    }

    fn some_fractions(&mut self, values: &Option<[f64; 4]>) -> WrittenValue {
        Ok(self.text.list(values.unwrap_or_default()))
    }

    fn conductor(&mut self, index: &Option<Conductor>) -> WrittenValue {
        let Some(Conductor { eta, k }) = index else {
            return Ok("none".to_owned());
        };
        let [eta, k] = [eta, k].map(|numbers| self.text.list(*numbers));
        Ok(format!("{{eta: {eta}, k: {k}}}"))
    }

    fn medium(&mut self, medium: &Option<Medium>) -> WrittenValue {
        let medium = medium.as_ref().map(|medium| self.text.medium(medium));
        Ok(medium.unwrap_or_else(|| "none".to_owned()))
    }

    #[expect(clippy::unused_self, reason = "a row of the table like the others")]
    fn flag(&mut self, value: &bool) -> WrittenValue {
        Ok(value.to_string())
    }

    #[expect(clippy::unused_self, reason = "a row of the table like the others")]
    fn microfacets(&mut self, value: &Microfacets) -> WrittenValue {
        keyword(Microfacets::KEYWORDS, value)
    }

    #[expect(clippy::unused_self, reason = "a row of the table like the others")]
    fn plastic(&mut self, value: &Plastic) -> WrittenValue {
        keyword(Plastic::KEYWORDS, value)
    }

    fn alpha(&mut self, alpha: &Alpha) -> WrittenValue {
        match alpha {
            Alpha::Opaque => Ok("opaque".to_owned()),
            Alpha::Blend => Ok("blend".to_owned()),
            Alpha::Mask(cutoff) => Ok(format!("{{mask: {}}}", self.number(cutoff)?)),
        }
    }

    /// The other material of a blend, which comes before it.
    fn material(&mut self, material: &Option<MaterialId>) -> WrittenValue {
        let scene = self.scene;
        let found = material.and_then(|id| scene.materials.get(id.0 as usize));
        match found {
            Some(Material::Standard(standard)) if self.left > 0 => {
                self.left -= 1;
                self.flow(standard)
            }
            _ => Err("a blend is not with an earlier standard material".to_owned()),
        }
    }

    fn map(&mut self, map: &Option<Map>) -> WrittenValue {
        // Resolve the texture.
        let Some(Map {
            texture,
            set,
            texture_from_surface,
        }) = map
        else {
            return Ok("none".to_owned());
        };
        let mut keys = match exists(*texture, self.scene)? {
            Texture::Sampled(sampled) => self.sampled(sampled)?,
            Texture::Procedural(pattern) => self.text.pattern(pattern),
            Texture::Uv | Texture::Image(_) => {
                let message =
                    "a material of glTF looks at a texture as only those of the course are";
                return Err(message.to_owned());
            }
        };
        // Write the placement where it is not the default.
        if *set != 0 {
            keys += &format!(", set: {set}");
        }
        if let Some(rows) = texture_from_surface {
            let rows = self.text.list(rows.iter().flatten().copied());
            keys += &format!(", transform: {rows}");
        }
        Ok(format!("{{{keys}}}"))
    }

    /// The keys of an image.
    fn sampled(&mut self, sampled: &Sampled) -> WrittenValue {
        let Sampled {
            image,
            wrap,
            filter,
        } = sampled;
        let mut keys = format!("file: {}", self.text.names.image(self.scene, *image)?);
        if *wrap != [Wrap::Repeat; 2] {
            let [u, v] = wrap.map(wrap_name);
            keys += &format!(", wrap: [{u}, {v}]");
        }
        match filter {
            Filter::Linear => {}
            Filter::Nearest => keys += ", filter: nearest",
        }
        Ok(keys)
    }
}

fn wrap_name(wrap: Wrap) -> &'static str {
    match wrap {
        Wrap::Repeat => "repeat",
        Wrap::Mirror => "mirror",
        Wrap::Clamp => "clamp",
    }
}

/// The keyword of a value in a table that has them all.
fn keyword<T: PartialEq>(table: &[(&str, T, &str)], value: &T) -> WrittenValue {
    let row = table.iter().find(|(_, entry, _)| entry == value);
    Ok(row.map_or("", |(keyword, ..)| keyword).to_owned())
}
