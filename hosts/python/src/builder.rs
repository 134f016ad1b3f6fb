//! Scenes from code: what `python/rtc/_builder.py` collects, as calls of the library's builder. Materials pass as the JSON of
//! the IR, arrays as bytes of their numbers.

use crate::findings::invalid;
use crate::{Scene, unknown};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rtc::{
    Camera, Environment, Light, Material, MaterialId, Mesh, MeshId, Phong, SceneBuilder, Shape,
    Standard, Texture, Transform,
};
use std::collections::BTreeMap;

/// A camera, as Python names its parts.
#[derive(FromPyObject, IntoPyObject)]
pub(crate) struct CameraWords {
    #[pyo3(item)]
    eye: [f64; 3],
    #[pyo3(item)]
    center: [f64; 3],
    #[pyo3(item)]
    up: Option<[f64; 3]>,
    #[pyo3(item)]
    size: [u32; 2],
    #[pyo3(item)]
    fov: Option<f64>,
    #[pyo3(item)]
    height: Option<f64>,
    #[pyo3(item)]
    lens: Option<(f64, u32)>,
}

impl CameraWords {
    pub(crate) fn of(camera: &Camera) -> Self {
        Self {
            eye: camera.position(),
            center: camera.target(),
            up: None,
            size: camera.pixels(),
            fov: camera.field_of_view(),
            height: None,
            lens: None,
        }
    }

    /// The camera; what Python leaves out is that of `base`, if there is one.
    fn camera(self, base: Option<Camera>) -> Camera {
        let mut camera = match base {
            Some(base) if base.position() == self.eye && base.target() == self.center => base,
            Some(base) => base.moved(self.eye, self.center),
            None => Camera::look_at(self.eye, self.center),
        };
        let [width, height] = self.size;
        camera = camera.size(width, height);
        if let Some(up) = self.up {
            camera = camera.up(up);
        }
        if let Some(height) = self.height {
            camera = camera.orthographic(height);
        } else if let Some(degrees) = self.fov.filter(|fov| Some(*fov) != camera.field_of_view()) {
            camera = camera.fov(degrees);
        }
        match self.lens {
            Some((radius, samples)) => camera.lens(radius, samples),
            None => camera,
        }
    }
}

/// A light, as Python names its parts.
#[derive(FromPyObject, IntoPyObject)]
pub(crate) struct LightWords {
    #[pyo3(item)]
    kind: String,
    #[pyo3(item)]
    position: Option<[f64; 3]>,
    #[pyo3(item)]
    direction: Option<[f64; 3]>,
    #[pyo3(item)]
    intensity: [f64; 3],
    #[pyo3(item)]
    angles: Option<[f64; 2]>,
    #[pyo3(item)]
    range: Option<f64>,
    #[pyo3(item)]
    radius: Option<f64>,
}

impl LightWords {
    pub(crate) fn of(light: &Light) -> Self {
        Self {
            kind: light.kind().to_owned(),
            position: light.position(),
            direction: light.direction(),
            intensity: light.intensity(),
            angles: None,
            range: None,
            radius: None,
        }
    }

    /// The light; what only `base` knows, as the angles of a spot, stays if nothing but the intensity is another.
    fn light(&self, base: Option<Light>) -> PyResult<Light> {
        let is_same = |base: &Light| {
            let own = Self::of(base);
            let places = (
                own.kind == self.kind,
                own.position == self.position,
                own.direction == self.direction,
            );
            places == (true, true, true)
                && self.angles.is_none()
                && self.range.is_none()
                && self.radius.is_none()
        };
        if let Some(base) = base.filter(is_same) {
            return Ok(base.color(self.intensity));
        }
        let part = |name: &str, value: Option<[f64; 3]>| {
            value.ok_or_else(|| {
                PyValueError::new_err(format!("a {} light needs `{name}`", self.kind))
            })
        };
        let light = match self.kind.as_str() {
            "sun" => Light::sun(part("direction", self.direction)?, self.intensity),
            "point" => Light::point(part("position", self.position)?, self.intensity),
            "spot" => {
                let (position, direction) = (
                    part("position", self.position)?,
                    part("direction", self.direction)?,
                );
                let angles = self
                    .angles
                    .ok_or_else(|| PyValueError::new_err("a spot needs `angles`"))?;
                Light::spot(position, direction, angles, self.intensity)
            }
            "plain" => Light::plain(
                part("position", self.position)?,
                self.intensity,
                self.radius.unwrap_or(0.0),
            ),
            kind => return Err(unknown("light", kind, "sun, point, spot, plain")),
        };
        Ok(match self.range {
            Some(distance) => light.range(distance),
            None => light,
        })
    }
}

/// A shape's values by their names in the IR; each is a list of numbers, row by row.
pub(crate) struct ShapeValues<'a> {
    kind: &'a str,
    values: &'a BTreeMap<String, Vec<f64>>,
}

impl ShapeValues<'_> {
    fn numbers<const N: usize>(&self, name: &str) -> PyResult<[f64; N]> {
        let value = self.values.get(name);
        let value = value
            .ok_or_else(|| PyValueError::new_err(format!("a {} needs `{name}`", self.kind)))?;
        let wrong = |_| {
            PyValueError::new_err(format!(
                "`{name}` of a {} has {N} numbers, not {}",
                self.kind,
                value.len()
            ))
        };
        value.as_slice().try_into().map_err(wrong)
    }

    fn number(&self, name: &str) -> PyResult<f64> {
        self.numbers::<1>(name).map(|[value]| value)
    }

    fn points<const N: usize, const M: usize>(&self, name: &str) -> PyResult<[[f64; 3]; N]> {
        let numbers = self.numbers::<M>(name)?;
        Ok(std::array::from_fn(|row| {
            std::array::from_fn(|column| numbers[3 * row + column])
        }))
    }

    fn shape(&self) -> PyResult<Shape> {
        Ok(match self.kind {
            "sphere" => Shape::sphere(self.numbers("center")?, self.number("radius")?),
            "plane" => Shape::plane(self.numbers("center")?, self.numbers("normal")?),
            "triangle" => Shape::triangle(self.points::<3, 9>("vertices")?),
            "quad" => Shape::quad(self.points::<4, 12>("vertices")?),
            "disc" => Shape::disc(
                self.numbers("center")?,
                self.numbers("normal")?,
                self.number("radius")?,
            ),
            "cylinder" => Shape::cylinder(
                self.numbers("base")?,
                self.numbers("axis")?,
                self.number("height")?,
                self.number("radius")?,
            ),
            "cone" => Shape::cone(
                self.numbers("base")?,
                self.numbers("up")?,
                self.number("radius")?,
            ),
            "paraboloid" => Shape::paraboloid(
                self.numbers("base")?,
                self.numbers("up")?,
                self.number("radius")?,
            ),
            "torus" => Shape::torus(
                self.numbers("center")?,
                self.numbers("axis")?,
                self.number("major")?,
                self.number("minor")?,
            ),
            "ellipsoid" => Shape::ellipsoid(self.numbers("center")?, self.points::<3, 9>("axes")?),
            "infinite_cylinder" => Shape::infinite_cylinder(
                self.numbers("center")?,
                self.numbers("axis")?,
                self.number("radius")?,
            ),
            kind => {
                let kinds = "sphere, plane, triangle, quad, disc, cylinder, cone, paraboloid, torus, ellipsoid, \
                             infinite_cylinder";
                return Err(unknown("shape", kind, kinds));
            }
        })
    }
}

/// A scene in the making; `None` once it is built.
#[pyclass]
pub(crate) struct Builder(Option<SceneBuilder>);

impl Builder {
    fn own(&mut self) -> PyResult<&mut SceneBuilder> {
        self.0
            .as_mut()
            .ok_or_else(|| PyValueError::new_err("the scene was built; make another builder"))
    }
}

#[pymethods]
impl Builder {
    #[new]
    fn new(camera: CameraWords) -> Self {
        Self(Some(SceneBuilder::new(camera.camera(None))))
    }

    /// Adds a light.
    fn light(&mut self, light: LightWords) -> PyResult<()> {
        let light = light.light(None)?;
        self.own()?.light(light);
        Ok(())
    }

    /// Light from all sides: of one radiance, or with a picture of width, height and 32-bit floats.
    fn environment(
        &mut self,
        radiance: [f64; 3],
        picture: Option<(u32, u32, Vec<u8>)>,
        degrees: f64,
    ) -> PyResult<()> {
        let environment = match picture {
            None => Environment::uniform(radiance),
            Some((width, height, bytes)) => Environment::image(width, height, &rows::<3>(&bytes))
                .tint(radiance)
                .turned(degrees),
        };
        self.own()?.environment(environment);
        Ok(())
    }

    /// Adds a mesh: 64-bit floats, indices of 32 bits, and 32-bit floats; its index.
    #[pyo3(signature = (positions, triangles, normals, uvs, colors))]
    fn mesh(
        &mut self,
        positions: &[u8],
        triangles: &[u8],
        normals: Option<&[u8]>,
        uvs: Option<&[u8]>,
        colors: Option<&[u8]>,
    ) -> PyResult<u32> {
        let positions: Vec<[f64; 3]> = numbers(positions, f64::from_ne_bytes);
        let triangles: Vec<[u32; 3]> = numbers(triangles, u32::from_ne_bytes);
        let mut mesh = Mesh::new(&positions, &triangles);
        if let Some(normals) = normals {
            mesh = mesh.normals(&rows::<3>(normals));
        }
        if let Some(uvs) = uvs {
            mesh = mesh.uvs(&rows::<2>(uvs));
        }
        if let Some(colors) = colors {
            mesh = mesh.colors(&rows::<4>(colors));
        }
        Ok(self.own()?.mesh(mesh).0)
    }

    /// Adds a texture: rows of red, green and blue from the top, of 8 bits in sRGB or 32-bit linear floats; its index.
    fn texture(
        &mut self,
        width: u32,
        height: u32,
        pixels: Vec<u8>,
        is_float: bool,
    ) -> PyResult<u32> {
        let texture = match is_float {
            true => Texture::rgb32f(width, height, &rows::<3>(&pixels)),
            false => Texture::rgb8(width, height, pixels),
        };
        Ok(self.own()?.texture(texture).0)
    }

    /// Adds a material, the JSON of the IR; its index.
    fn material(&mut self, json: &str) -> PyResult<u32> {
        let material = material(json)?;
        Ok(self.own()?.material(material).0)
    }

    /// Adds a shape with a material.
    fn shape(
        &mut self,
        kind: &str,
        values: BTreeMap<String, Vec<f64>>,
        material: u32,
        name: Option<&str>,
    ) -> PyResult<()> {
        let values = &values;
        let shape = ShapeValues { kind, values }.shape()?;
        self.add(shape, material, name)
    }

    /// Places a mesh by the three columns of a matrix and the origin.
    fn instance(
        &mut self,
        mesh: u32,
        columns: [[f64; 3]; 4],
        material: u32,
        name: Option<&str>,
    ) -> PyResult<()> {
        let shape = Shape::instance(MeshId(mesh), Transform::from_columns(columns));
        self.add(shape, material, name)
    }

    /// Any setting by its name in the IR, with its value in JSON.
    fn set(&mut self, name: &str, value: &str) -> PyResult<()> {
        self.own()?.set(name, value);
        Ok(())
    }

    /// The scene, validated.
    fn build(&mut self, py: Python<'_>) -> PyResult<Scene> {
        self.own()?;
        let builder = self.0.take();
        let built = py.detach(|| builder.map(SceneBuilder::build).transpose());
        match built {
            Ok(Some(scene)) => Ok(Scene(scene)),
            Ok(None) => self.own().map(|_| unreachable!("`own` has said so")),
            Err(found) => Err(invalid(py, &found)),
        }
    }
}

impl Builder {
    fn add(&mut self, shape: Shape, material: u32, name: Option<&str>) -> PyResult<()> {
        let builder = self.own()?;
        let object = builder.add(shape, MaterialId(material));
        if let Some(name) = name {
            builder.name(object, name);
        }
        Ok(())
    }
}

/// An object of a scene: name, kind of shape, index of its material, bounds.
type ObjectRow = (String, String, u32, Option<[[f64; 3]; 2]>);

#[pymethods]
impl Scene {
    fn camera(&self) -> Option<CameraWords> {
        self.0.tree().map(|tree| CameraWords::of(&tree.camera()))
    }

    /// The lights, without the environment and emissive surfaces.
    fn lights(&self) -> Vec<LightWords> {
        self.0.tree().map_or_else(Vec::new, |tree| {
            tree.lights().map(|light| LightWords::of(&light)).collect()
        })
    }

    /// The materials, each as the JSON of the IR.
    fn materials(&self) -> PyResult<Vec<String>> {
        let tree = self.0.tree();
        let materials = tree.as_ref().map_or(&[][..], |tree| tree.materials());
        materials
            .iter()
            .map(|material| serde_json::to_string(material).map_err(|error| wrong(&error)))
            .collect()
    }

    fn objects(&self) -> Vec<ObjectRow> {
        self.0.tree().map_or_else(Vec::new, |tree| {
            let row = |object: rtc::Object<'_>| {
                (
                    object.name().to_owned(),
                    object.shape().kind().to_owned(),
                    object.material().0,
                    object.bounds(),
                )
            };
            tree.objects().map(row).collect()
        })
    }

    fn set_camera(&mut self, py: Python<'_>, camera: CameraWords) -> PyResult<()> {
        self.edit(py, |builder| {
            let camera = camera.camera(Some(builder.camera()));
            builder.set_camera(camera);
        })
    }

    /// Replaces all lights; each has the index of the light that it was before, if it was one.
    fn set_lights(
        &mut self,
        py: Python<'_>,
        lights: Vec<(Option<usize>, LightWords)>,
    ) -> PyResult<()> {
        let own: Vec<Light> = self
            .0
            .tree()
            .map_or_else(Vec::new, |tree| tree.lights().collect());
        let base = |index: Option<usize>| index.and_then(|index| own.get(index).cloned());
        let lights = lights
            .into_iter()
            .map(|(index, words)| words.light(base(index)));
        let lights = lights.collect::<PyResult<Vec<_>>>()?;
        self.edit(py, |builder| {
            builder.remove_lights();
            for light in lights {
                builder.light(light);
            }
        })
    }

    fn set_material(&mut self, py: Python<'_>, index: u32, json: &str) -> PyResult<()> {
        let material = material(json)?;
        self.edit(py, |builder| {
            if let Some(own) = builder.material_mut(MaterialId(index)) {
                *own = material;
            }
        })
    }
}

impl Scene {
    fn edit(
        &mut self,
        py: Python<'_>,
        change: impl FnOnce(&mut SceneBuilder) + Send,
    ) -> PyResult<()> {
        let edited = py.detach(|| self.0.edit(change));
        edited.map_err(|found| invalid(py, &found))
    }
}

/// The default values of a material of a kind, as JSON, and the names of all its values.
#[pyfunction]
pub(crate) fn material_values(kind: &str) -> PyResult<(String, Vec<String>)> {
    let default = match kind {
        "standard" => Material::from(Standard::default()),
        "phong" => Material::from(Phong::default()),
        _ => return Err(unknown("material", kind, "standard, phong")),
    };
    let json = serde_json::to_string(&default).map_err(|error| wrong(&error))?;
    // An unknown name is refused with all that are known.
    let probe = format!(r#"{{"{kind}": {{"": 0}}}}"#);
    let refusal = serde_json::from_str::<Material>(&probe)
        .err()
        .map(|error| error.to_string());
    let names = refusal
        .as_deref()
        .unwrap_or_default()
        .split('`')
        .skip(3)
        .step_by(2);
    Ok((json, names.map(str::to_owned).collect()))
}

fn material(json: &str) -> PyResult<Material> {
    serde_json::from_str(json).map_err(|error| wrong(&error))
}

fn wrong(error: &serde_json::Error) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Bytes as rows of 32-bit floats of this machine.
fn rows<const N: usize>(bytes: &[u8]) -> Vec<[f32; N]> {
    numbers(bytes, f32::from_ne_bytes)
}

/// Bytes as rows of numbers of this machine.
fn numbers<T: Copy + Default, const B: usize, const N: usize>(
    bytes: &[u8],
    number: fn([u8; B]) -> T,
) -> Vec<[T; N]> {
    let (numbers, _) = bytes.as_chunks::<B>();
    let (rows, _) = numbers.as_chunks::<N>();
    rows.iter().map(|row| row.map(number)).collect()
}
