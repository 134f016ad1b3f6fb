//! Directives: each changes the graphics state, or adds a part of the scene.

use super::Lowering;
use super::parameter::{self, Parameters};
use super::plugins::{AREA_LIGHTS, DIRECTIVES, TARGETS};
use super::state::{ActiveTransform, StateOpener};
use super::token::{PbrtToken, PbrtTokenKind};
use crate::exchange::SpannedText;
use crate::exchange::transform::AffineTransform;
use crate::plugin::PluginKind;
use rtc_diag::{Diagnostic, clip, codes, nearest};
use rtc_math::Vec3;
use rtc_source::{FileId, Resource, Span};
use std::rc::Rc;

/// The names of the directives.
fn names() -> impl Iterator<Item = &'static str> {
    DIRECTIVES.iter().map(|directive| directive.name)
}

/// The directives without an argument, and first lines that only pbrt files have.
const BARE: [&[u8]; 4] = [
    b"WorldBegin",
    b"AttributeBegin",
    b"Identity",
    b"TransformBegin",
];

/// The directives of the view, which end with the beginning of the world.
const VIEW: [&str; 6] = [
    "Camera",
    "Film",
    "Integrator",
    "PixelFilter",
    "Sampler",
    "SurfaceIntegrator",
];

/// The options that change no picture but for its noise.
const OPTIONS: [&str; 9] = [
    "disabletexturefiltering",
    "disablewavelengthjitter",
    "displacementedgescale",
    "msereferenceimage",
    "msereferenceout",
    "pixelstats",
    "rendercoordsys",
    "seed",
    "wavefront",
];

/// The number of tokens between charges to the budget.
const CHARGED_TOKENS: u64 = 1 << 12;

/// Whether the first line that is no comment is a directive of pbrt with an argument.
pub(crate) fn begins_scene(bytes: &[u8]) -> bool {
    let head = bytes.get(..4096).unwrap_or(bytes);
    let lines = head.split(|byte| matches!(byte, b'\n' | b'\r'));
    let mut lines = lines.map(<[u8]>::trim_ascii);
    let Some(first) = lines.find(|line| !line.is_empty() && !line.starts_with(b"#")) else {
        return false;
    };
    let is_directive = |word: &str| {
        let rest = first.strip_prefix(word.as_bytes()).unwrap_or_default();
        let starts = rest.trim_ascii_start().first();
        let has_space = rest.first().is_some_and(u8::is_ascii_whitespace);
        has_space && starts.is_some_and(|byte| byte.is_ascii_digit() || b"\"-[.".contains(byte))
    };
    let has_colon = first.contains(&b':') && !first.contains(&b'"');
    BARE.contains(&first) || (!has_colon && names().any(is_directive))
}

/// Whether a text has a directive that only whole scenes have.
pub(super) fn has_view(bytes: &[u8]) -> bool {
    ["WorldBegin", "Camera", "Film"].into_iter().any(|word| {
        let mut places = memchr::memmem::find_iter(bytes, word);
        places.any(|at| {
            let line = memchr::memrchr(b'\n', &bytes[..at]).map_or(0, |end| end + 1);
            bytes[line..at].trim_ascii().is_empty()
        })
    })
}

impl Lowering<'_> {
    /// Reads the scene and the files that it includes; `None` if it has no text.
    pub(super) fn read(&mut self, file: FileId) -> Option<()> {
        let scene = self.open_scene(file)?;
        self.files.push(scene);
        let mut charged = 0;
        while let Some(mut open) = self.files.pop() {
            let is_import = open.is_import;
            let Some(token) = open.reader.next() else {
                if is_import {
                    let span = Span::new(file, 0, 0);
                    self.close(StateOpener::Import, "the end of the file", span);
                }
                continue;
            };
            charged += 1;
            let span = open.reader.span(token);
            self.files.push(open);
            self.directive(token);
            // Charge the tokens read, and stop at the end.
            if let Some(open) = self.files.last_mut() {
                charged += std::mem::take(&mut open.reader.count);
            }
            if charged >= CHARGED_TOKENS {
                self.charge(Resource::Nodes, charged, span);
                charged = 0;
            }
            if self.is_exhausted {
                break;
            }
        }
        self.close_all();
        Some(())
    }

    /// The file that is read.
    fn reader(&mut self) -> &mut super::token::TokenReader {
        let last = self.files.len() - 1;
        &mut self.files[last].reader
    }

    fn directive(&mut self, token: PbrtToken) {
        // A directive begins with a word.
        let SpannedText { text: name, span } = self.reader().text(token);
        if token.kind != PbrtTokenKind::Word {
            let message = match token.kind {
                PbrtTokenKind::Unterminated => "this string is not closed on its line".to_owned(),
                _ => format!("`{}` stands where a directive is expected", clip(&name)),
            };
            self.report(&codes::PBRT_SYNTAX, span, message);
            return self.skip_arguments();
        }
        // Transforms, attributes and files are handled here, plugins apart.
        match name.as_str() {
            "Identity" => self.transform_by(|_| AffineTransform::IDENTITY),
            "Translate" => self.translate(span),
            "Scale" => self.scale(span),
            "Rotate" => self.rotate(span),
            "LookAt" => self.look_at(span),
            "Transform" | "ConcatTransform" => self.matrix(&name, span),
            "CoordinateSystem" | "CoordSysTransform" => self.coordinate_system(&name, span),
            "ActiveTransform" => self.active_transform(span),
            "TransformTimes" => drop(self.numbers::<2>("TransformTimes", span)),
            "AttributeBegin" => self.open(StateOpener::Attribute, span),
            "AttributeEnd" => self.close(StateOpener::Attribute, &name, span),
            "TransformBegin" => self.open(StateOpener::Transform, span),
            "TransformEnd" => self.close(StateOpener::Transform, &name, span),
            "ObjectBegin" => self.object_begin(span),
            "ObjectEnd" => self.object_end(span),
            "ObjectInstance" => self.object_instance(span),
            "ReverseOrientation" => {
                self.state.reverse_orientation = !self.state.reverse_orientation;
            }
            "WorldBegin" => self.world_begin(span),
            "WorldEnd" => {}
            "Include" | "Import" => {
                if let Some(path) = self.argument(&name, span) {
                    self.open_included(&path, name == "Import");
                }
            }
            _ => self.plugin_directive(&name, span),
        }
    }

    /// The directives with a name and parameters.
    fn plugin_directive(&mut self, name: &str, span: Span) {
        // The other directives name a plugin with parameters.
        match name {
            "ColorSpace" => {
                if let Some(space) = self.argument(name, span)
                    && space.text != "srgb"
                {
                    let space_name = clip(&space.text);
                    let message = format!("the colours of `{space_name}` are taken as sRGB");
                    self.approximate(space.span, message);
                }
            }
            "Option" => self.option(),
            "MediumInterface" => {
                let media: Vec<SpannedText> = self.arguments().collect();
                self.medium_interface(&media);
            }
            "NamedMaterial" => {
                if let Some(name) = self.argument(name, span) {
                    self.named_material(&name);
                }
            }
            "Texture" => self.texture_directive(span),
            _ if names().any(|known| known == name) => {
                let Some(plugin) = self.argument(name, span) else {
                    return self.skip_arguments();
                };
                let parameters = self.parameters();
                self.plugin(name, plugin, parameters, span);
            }
            _ => {
                let message = format!("`{}` is no directive: it is left out", clip(name));
                let mut diagnostic = Diagnostic::new(&codes::PBRT_PLUGIN, message).at(span, "");
                if let Some(near) = nearest(name, names()) {
                    diagnostic = diagnostic.hint(format!("did you mean `{near}`?"));
                }
                self.sink.push(diagnostic);
                self.skip_arguments();
            }
        }
    }

    fn plugin(&mut self, directive: &str, plugin: SpannedText, parameters: Parameters, span: Span) {
        if self.in_world && VIEW.contains(&directive) {
            let message = format!("`{directive}` has no effect behind `WorldBegin`");
            return self.doubtful(span, message);
        }
        match directive {
            "Camera" => self.camera(plugin, parameters, span),
            "Film" => self.view.film = Some((plugin, parameters)),
            "Sampler" => self.view.sampler = Some((plugin, parameters)),
            "Integrator" | "SurfaceIntegrator" => self.view.integrator = Some((plugin, parameters)),
            "PixelFilter" => self.view.filter = Some((plugin, parameters)),
            "Material" => {
                let parameters = self.with_attributes("material", parameters);
                let material = self.material(&plugin, &parameters);
                self.state.material = Some(material);
            }
            "MakeNamedMaterial" => self.make_named_material(plugin, &parameters),
            "LightSource" => {
                let parameters = self.with_attributes("light", parameters);
                self.light_source(&plugin, &parameters);
            }
            "AreaLightSource" => {
                let parameters = self.with_attributes("light", parameters);
                self.area_light_source(&plugin, &parameters);
            }
            "Shape" => {
                let parameters = self.with_attributes("shape", parameters);
                self.shape(&plugin, &parameters, span);
            }
            "Attribute" => self.attribute(plugin, parameters, span),
            "MakeNamedMedium" => self.make_named_medium(plugin, &parameters),
            // How rays find surfaces changes no picture.
            "Accelerator" | "VolumeIntegrator" | "Renderer" => {}
            _ => {}
        }
    }

    /// Warns of an option that changes the picture.
    fn option(&mut self) {
        for option in self.parameters().list {
            if !OPTIONS.contains(&option.name.text.as_str()) {
                let message = format!("the option `{}` has no effect", clip(&option.name.text));
                self.report(&codes::PBRT_IGNORED, option.name.span, message);
            }
        }
    }

    /// `Attribute`: defaults of the plugins of a kind that follow.
    fn attribute(&mut self, target: SpannedText, parameters: Parameters, span: Span) {
        let Some((_, kind)) = TARGETS.iter().find(|(name, _)| *name == target.text) else {
            let message = format!("`{}` has no attributes", clip(&target.text));
            return self.report(&codes::PBRT_IGNORED, target.span, message);
        };
        for parameter in &parameters.list {
            let name = &parameter.name;
            // Area lights are lights, too.
            let is_of = |kind: &PluginKind| {
                let mut plugins = kind.plugins.iter();
                plugins.any(|plugin| kind.has(plugin.name, &name.text))
            };
            let is_read = is_of(kind) || target.text == "light" && is_of(&AREA_LIGHTS);
            if !is_read {
                let name_text = clip(&name.text);
                let message = format!("`{name_text}` has no effect on any {}", target.text);
                self.report(&codes::PBRT_IGNORED, name.span, message);
            }
        }
        // The defaults are copied where an outer state has them too.
        let defaults = self.state.attributes.entry(target.text).or_default();
        let copied = match Rc::strong_count(defaults) {
            1 => 0,
            _ => defaults.len() as u64,
        };
        let named = (parameters.list.into_iter()).map(|own| (own.name.text.clone(), own));
        Rc::make_mut(defaults).extend(named);
        self.charge(Resource::Nodes, copied, span);
    }

    fn with_attributes(&self, target: &str, mut parameters: Parameters) -> Parameters {
        parameters.defaults = self.state.attributes.get(target).cloned();
        parameters
    }

    fn texture_directive(&mut self, span: Span) {
        let names: Vec<SpannedText> = self.some_arguments(3);
        let [name, kind, plugin] = match <[SpannedText; 3]>::try_from(names) {
            Ok(names) => names,
            Err(_) => {
                let message =
                    "`Texture` needs a name, a type (as `float`) and a class (as `imagemap`)";
                self.report(&codes::PBRT_SYNTAX, span, message);
                return self.skip_arguments();
            }
        };
        let parameters = self.parameters();
        let parameters = self.with_attributes("texture", parameters);
        self.texture(name, &kind, &plugin, &parameters);
    }

    fn parameters(&mut self) -> Parameters {
        let mut found = Vec::new();
        let parameters = parameter::read(self.reader(), &mut |diagnostic| found.push(diagnostic));
        for diagnostic in found {
            self.sink.push(diagnostic);
        }
        parameters
    }

    /// The string that follows; without one that is reported.
    fn argument(&mut self, directive: &str, span: Span) -> Option<SpannedText> {
        let reader = self.reader();
        let Some(token) = reader.next_if(PbrtTokenKind::Quoted) else {
            let message = format!("`{}` needs a name between quotes", clip(directive));
            self.report(&codes::PBRT_SYNTAX, span, message);
            return None;
        };
        Some(reader.text(token))
    }

    /// The strings that follow.
    fn arguments(&mut self) -> impl Iterator<Item = SpannedText> {
        let reader = self.reader();
        std::iter::from_fn(move || {
            let token = reader.next_if(PbrtTokenKind::Quoted)?;
            Some(reader.text(token))
        })
    }

    fn some_arguments(&mut self, count: usize) -> Vec<SpannedText> {
        self.arguments().take(count).collect()
    }

    /// Skips to the next directive.
    fn skip_arguments(&mut self) {
        let reader = self.reader();
        while let Some(token) = reader.peek() {
            let bytes = reader.bytes(token);
            let is_directive =
                token.kind == PbrtTokenKind::Word && names().any(|known| known.as_bytes() == bytes);
            if is_directive {
                return;
            }
            reader.next();
        }
    }

    /// The numbers that follow, between brackets or not.
    fn numbers<const N: usize>(&mut self, directive: &str, span: Span) -> Option<[f64; N]> {
        let reader = self.reader();
        let is_list = reader.next_if(PbrtTokenKind::Open).is_some();
        let mut numbers = [0.0; N];
        let mut wrong = None;
        for number in &mut numbers {
            let token = reader.peek();
            match token.and_then(|token| reader.number(token)) {
                Some(known) => *number = known,
                None => {
                    // The next directive is not the error.
                    let is_word = |token: &PbrtToken| {
                        !reader
                            .bytes(*token)
                            .first()
                            .is_some_and(u8::is_ascii_uppercase)
                    };
                    let word = token.filter(is_word);
                    wrong = Some(word.map_or(span, |token| reader.span(token)));
                    break;
                }
            }
            reader.next();
        }
        let is_closed =
            !is_list || wrong.is_some() || reader.next_if(PbrtTokenKind::Close).is_some();
        if wrong.is_some() || !is_closed {
            let message = format!("`{}` needs {N} numbers", clip(directive));
            self.report(&codes::PBRT_SYNTAX, wrong.unwrap_or(span), message);
            self.skip_arguments();
            return None;
        }
        Some(numbers)
    }

    fn translate(&mut self, span: Span) {
        if let Some(by) = self.numbers::<3>("Translate", span) {
            self.transform_by(|current| current.after(&AffineTransform::translation(by)));
        }
    }

    fn scale(&mut self, span: Span) {
        if let Some(by) = self.numbers::<3>("Scale", span) {
            self.transform_by(|current| current.after(&AffineTransform::scale(by)));
        }
    }

    fn rotate(&mut self, span: Span) {
        let Some([degrees, x, y, z]) = self.numbers::<4>("Rotate", span) else {
            return;
        };
        match AffineTransform::rotation([x, y, z], degrees) {
            Some(rotation) => self.transform_by(|current| current.after(&rotation)),
            None => self.mistake(span, "the axis of `Rotate` has no length"),
        }
    }

    fn look_at(&mut self, span: Span) {
        let Some(n) = self.numbers::<9>("LookAt", span) else {
            return;
        };
        let point = |at: usize| [n[at], n[at + 1], n[at + 2]];
        let from_camera = AffineTransform::look_at(point(0), point(3), Some(point(6)));
        match from_camera.and_then(|from_camera| from_camera.inverse()) {
            Some(to_camera) => self.transform_by(|current| current.after(&to_camera)),
            None => self.mistake(span, "the points of `LookAt` give no direction"),
        }
    }

    /// A matrix in columns.
    fn matrix(&mut self, name: &str, span: Span) {
        let Some(n) = self.numbers::<16>(name, span) else {
            return;
        };
        if n[3] != 0.0 || n[7] != 0.0 || n[11] != 0.0 || n[15] == 0.0 {
            let message = format!("the matrix of `{name}` is not affine: its last row is left out");
            self.doubtful(span, message);
        }
        let whole = if n[15] == 0.0 { 1.0 } else { n[15] };
        let column = |at: usize| Vec3::new(n[at], n[at + 1], n[at + 2]) / whole;
        let matrix = AffineTransform([column(0), column(4), column(8), column(12)]);
        self.transform_by(|current| match name {
            "Transform" => matrix,
            _ => current.after(&matrix),
        });
    }

    fn coordinate_system(&mut self, directive: &str, span: Span) {
        let Some(name) = self.argument(directive, span) else {
            return;
        };
        if directive == "CoordinateSystem" {
            self.systems.insert(name.text, self.state.transform);
            return;
        }
        match self.systems.get(&name.text).copied() {
            Some(system) => self.transform_by(|_| system),
            None => {
                let message = format!("there is no coordinate system `{}`", clip(&name.text));
                self.doubtful(name.span, message);
            }
        }
    }

    fn active_transform(&mut self, span: Span) {
        let reader = self.reader();
        let token = reader.next_if(PbrtTokenKind::Word);
        let active = match token.map(|token| reader.bytes(token)) {
            Some(b"All") => ActiveTransform::All,
            Some(b"StartTime") => ActiveTransform::Start,
            Some(b"EndTime") => ActiveTransform::End,
            _ => {
                let message = "`ActiveTransform` is followed by `All`, `StartTime` or `EndTime`";
                return self.report(&codes::PBRT_SYNTAX, span, message);
            }
        };
        if active == ActiveTransform::End {
            self.approximate(span, "motion is left out: the scene is shown at its start");
        }
        self.state.active = active;
    }

    fn object_begin(&mut self, span: Span) {
        let Some(name) = self.argument("ObjectBegin", span) else {
            return;
        };
        self.open(StateOpener::Object, span);
        if let Some((outer, shapes)) = self.open_object.replace((name, Vec::new())) {
            self.doubtful(
                span,
                "an object is defined inside of another one, and ends it",
            );
            self.objects.insert(outer.text, Rc::new(shapes));
        }
    }

    fn object_end(&mut self, span: Span) {
        if let Some((name, shapes)) = self.open_object.take() {
            self.objects.insert(name.text, Rc::new(shapes));
        }
        self.close(StateOpener::Object, "ObjectEnd", span);
    }

    fn object_instance(&mut self, span: Span) {
        let Some(name) = self.argument("ObjectInstance", span) else {
            return;
        };
        if self.open_object.is_some() {
            let message = "an object cannot hold an instance of another one: it is left out";
            return self.doubtful(span, message);
        }
        let Some(shapes) = self.objects.get(&name.text).cloned() else {
            let message = format!("there is no object `{}`: it is left out", clip(&name.text));
            return self.doubtful(name.span, message);
        };
        let outer = self.state.transform;
        for shape in shapes.iter() {
            if self.place(shape, &outer).is_none() {
                break;
            }
        }
    }

    fn world_begin(&mut self, span: Span) {
        if self.in_world {
            return self.mistake(span, "`WorldBegin` stands here a second time");
        }
        self.in_world = true;
        let scene = &self.scene;
        if !scene.surfaces.is_empty() || !scene.lights.is_empty() || scene.environment.is_some() {
            let message = "shapes and lights before `WorldBegin` are shown; pbrt leaves them out";
            self.doubtful(span, message);
        }
        self.finish_view();
        self.state.transform = AffineTransform::IDENTITY;
        self.state.active = ActiveTransform::All;
        self.systems
            .insert("world".to_owned(), AffineTransform::IDENTITY);
    }

    /// Ends the scene.
    pub(super) fn finish(&mut self) {
        if !self.in_world {
            self.finish_view();
        }
        self.finish_environment();
    }
}
