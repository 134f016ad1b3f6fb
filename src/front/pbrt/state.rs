//! The graphics state, which applies to the following shapes and lights.

use super::Lowering;
use super::light::AreaLight;
use super::material::LoweredMaterial;
use super::medium::InterfaceMedia;
use super::parameter::DefaultParameters;
use crate::exchange::transform::AffineTransform;
use rtc_diag::{Diagnostic, clip, codes};
use rtc_source::Span;
use std::collections::BTreeMap;
use std::rc::Rc;

/// The deepest nesting of attributes, transforms and objects.
const MAX_DEPTH: usize = 1024;

/// Which of the two transforms of a moving scene directives change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum ActiveTransform {
    #[default]
    All,
    Start,
    End,
}

/// The attributes of the following shapes and lights.
#[derive(Clone, Default)]
pub(super) struct GraphicsState {
    /// The current transformation matrix: before the world from the world to the camera, in it from
    /// the object to the world. It is that of the start of a motion.
    pub(super) transform: AffineTransform,
    pub(super) active: ActiveTransform,
    pub(super) material: Option<Rc<LoweredMaterial>>,
    pub(super) area_light: Option<Rc<AreaLight>>,
    pub(super) reverse_orientation: bool,
    /// The participating media of the following shapes and of the camera.
    pub(super) media: InterfaceMedia,
    /// The parameters that `Attribute` gave to all plugins of a kind, of which there are four.
    pub(super) attributes: BTreeMap<String, Rc<DefaultParameters>>,
}

/// What opened a nested state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StateOpener {
    Attribute,
    Transform,
    Object,
    Import,
}

impl StateOpener {
    fn name(self) -> &'static str {
        match self {
            Self::Attribute => "AttributeBegin",
            Self::Transform => "TransformBegin",
            Self::Object => "ObjectBegin",
            Self::Import => "Import",
        }
    }
}

/// The states that were saved.
#[derive(Default)]
pub(super) struct StateStack {
    saved: Vec<(StateOpener, GraphicsState, Span)>,
    is_reported: bool,
    /// The number of open states beyond the deepest saved one.
    beyond: usize,
}

impl Lowering<'_> {
    /// Changes the transform of the start of the motion.
    pub(super) fn transform_by(
        &mut self,
        change: impl FnOnce(&AffineTransform) -> AffineTransform,
    ) {
        if self.state.active != ActiveTransform::End {
            let changed = change(&self.state.transform);
            // Products of large matrices would be infinite.
            if changed.0.iter().all(|column| column.is_finite()) {
                self.state.transform = changed;
            }
        }
    }

    /// Saves the state.
    pub(super) fn open(&mut self, opener: StateOpener, span: Span) {
        if self.stack.saved.len() < MAX_DEPTH {
            return self.stack.saved.push((opener, self.state.clone(), span));
        }
        self.stack.beyond += 1;
        if !self.stack.is_reported {
            self.stack.is_reported = true;
            self.mistake(
                span,
                format!("attributes are nested more than {MAX_DEPTH} deep"),
            );
        }
    }

    /// Restores the state that was saved last.
    pub(super) fn close(&mut self, opener: StateOpener, closer: &str, span: Span) {
        if self.stack.beyond > 0 {
            self.stack.beyond -= 1;
            return;
        }
        match self.stack.saved.last() {
            Some((opened, _, _)) if *opened == opener => {}
            Some((opened, _, at)) => {
                let (name, at) = (opened.name(), *at);
                let message = format!("`{}` does not end `{name}`", clip(closer));
                let diagnostic = Diagnostic::new(&codes::PBRT_DOUBTFUL, message);
                self.sink
                    .push(diagnostic.at(span, "").also(at, "opened here"));
                // An end of another kind still ends something.
                if opener == StateOpener::Import {
                    return;
                }
            }
            None => {
                let message = format!("`{}` ends nothing", clip(closer));
                return self.doubtful(span, message);
            }
        }
        let Some((opened, saved, _)) = self.stack.saved.pop() else {
            return;
        };
        match opened {
            StateOpener::Transform => {
                self.state.transform = saved.transform;
                self.state.active = saved.active;
            }
            _ => self.state = saved,
        }
    }

    /// Reports states that were not closed.
    pub(super) fn close_all(&mut self) {
        if self.is_exhausted {
            return;
        }
        for (opener, _, span) in std::mem::take(&mut self.stack.saved) {
            self.doubtful(span, format!("this `{}` is not closed", opener.name()));
        }
    }
}
