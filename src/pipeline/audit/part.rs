//! Audits a part of a picture: the sums of its samples are compared.

use super::super::{PictureSetup, RenderError, RenderObserver, RenderShard, RenderSubject};
use super::{
    AuditFinding, AuditResult, AuditSubject, ODDS, TileDraw, TileRenderer, check_mode,
    check_software, claim, differing, drawn, finding,
};
use rtc_image::TileHash;
use rtc_render::{Crop, PartialFilm, RenderSelection};
use rtc_study::least_faults;

impl RenderShard {
    /// The setup that renders the part again.
    ///
    /// # Errors
    /// If it can't be audited.
    pub fn setup(&self) -> Result<PictureSetup, RenderError> {
        let metadata = self.metadata();
        check_software(&metadata)?;
        if self.is_refined() {
            let words = "it was sampled to a target error, so the samples of a pixel depend on \
                         the whole picture";
            return Err(RenderError::Refused(words.to_owned()));
        }
        if self.aovs().iter().any(|aov| aov.is_of_samples()) {
            let words = "it has layers that are not made tile by tile".to_owned();
            return Err(RenderError::Refused(words));
        }
        let mut setup = claim::setup(&metadata.settings, self.look().kind, self.aovs())?;
        setup.look.has_metadata = self.look().has_metadata();
        Ok(setup)
    }

    /// Audits the part against its scene, which `setup` has validated: each tile takes at most
    /// `rays` rays.
    ///
    /// # Errors
    /// If the part can't be rendered again.
    pub fn audit(
        &self,
        setup: &PictureSetup,
        subject: &mut RenderSubject,
        (draw, rays): (TileDraw, u64),
        observer: &RenderObserver<'_>,
    ) -> Result<AuditResult, RenderError> {
        // The metadata of scene, settings, output transform and crop.
        let scene = &subject.validated.lowered.scene;
        let window = setup.window(scene)?;
        let mut findings = differing(&self.metadata(), &setup.metadata(scene), true);
        if window != self.window() {
            let words = |crop: Crop| format!("{crop:?}");
            findings.push(finding(
                AuditSubject::Size,
                words(self.window()),
                words(window),
            ));
        }
        let look = setup.look.resolve(&subject.validated.scene.settings().mode);
        if (self.look(), self.arithmetic()) != (&look, setup.arithmetic) {
            let words = |look| serde_json::to_string(look).unwrap_or_default();
            let (stated, anew) = (words(self.look()), words(&look));
            findings.push(finding(AuditSubject::Settings, stated, anew));
        }
        if !findings.is_empty() {
            return Ok(AuditResult::refuted(findings));
        }
        check_mode(subject)?;
        // The drawn tiles.
        let tiles: Vec<(usize, Crop)> = self.film().held_tiles().collect();
        let draws = drawn(tiles.len(), draw);
        let anew = TileRenderer::new(setup, subject, window, rays)?;
        let made = anew.on_threads(&draws, |index| {
            let (tile, area) = tiles[*index];
            self.compare((*index, tile), area, &anew, observer)
        })?;
        let findings: Vec<_> = made.into_iter().flatten().collect();
        let fewer_than = findings
            .is_empty()
            .then(|| least_faults(tiles.len() as u64, draws.len() as u64, ODDS));
        Ok(AuditResult {
            all: tiles.len() as u64,
            film_tiles: 1,
            drawn: draws.iter().map(|index| *index as u64).collect(),
            findings,
            fewer_than: fewer_than.flatten(),
            settings: subject.replaced.clone(),
        })
    }

    /// Renders a tile again and compares its sums and layers.
    fn compare(
        &self,
        (index, tile): (usize, usize),
        area: Crop,
        anew: &TileRenderer<'_>,
        observer: &RenderObserver<'_>,
    ) -> Result<Option<AuditFinding>, RenderError> {
        let mut made = None::<PartialFilm>;
        for samples in self.film().samples_of_tile(tile) {
            let film = anew.sums(area, samples, observer)?;
            match &mut made {
                None => made = Some(film),
                Some(made) => made.add(film).map_err(refused)?,
            }
        }
        let mut bytes = made.map_or_else(Vec::new, |made| made.tile_bytes(0));
        if self.has_layers(tile) {
            let job = RenderSelection {
                crop: Some(area),
                ..anew.job
            };
            let layers = anew.layers(&job, observer)?;
            bytes.extend(layers.values.iter().flat_map(|value| value.to_le_bytes()));
        }
        let [stated, own] = [self.tile_bytes(tile), bytes].map(|bytes| TileHash::of_tile(&bytes));
        Ok((stated != own).then(|| AuditFinding {
            tile: Some(index as u64),
            area: Some(area),
            ..finding(AuditSubject::Values, stated, own)
        }))
    }
}

fn refused(error: impl ToString) -> RenderError {
    RenderError::Refused(error.to_string())
}
