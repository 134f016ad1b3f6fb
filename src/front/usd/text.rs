//! Layers as text (`.usda`): one pass over the bytes, with the span of each prim and property.
//! After a mistake the next line is read, so that up to 16 are found.

mod token;

use super::layer::{
    ArcTarget, Layer, LayerOffset, ListOp, MAX_DEPTH, PrimSpec, Specifier, StoredValue, SubLayer,
    Value,
};
use crate::exchange::SpannedText;
use rtc_source::{Budget, FileId, LimitExceeded, Span};
use token::{ValueType, is_name};

/// After so many mistakes a text is not read further.
const MAX_MISTAKES: usize = 16;
/// The deepest brackets of a value: lists of matrices.
const MAX_BRACKETS: usize = 8;
/// The step in which memory is charged, in bytes.
const STEP: u64 = 1 << 16;
/// The memory of a prim, of a property, of a word and of a number, in bytes, rounded up.
const PRIM: u64 = 1024;
const PROPERTY: u64 = 768;
const WORD: u64 = 128;
const NUMBER: u64 = 16;

/// Why a layer is not read.
pub(super) enum LayerParseError {
    /// Mistakes of the text, at most [`MAX_MISTAKES`].
    Mistakes(Vec<(Span, String)>),
    /// A binary file is damaged.
    Damaged(&'static str),
    Limit(LimitExceeded),
}

/// Reads a layer.
///
/// # Errors
/// All mistakes of the text, or the limit that it exceeds.
pub(super) fn read(file: FileId, bytes: &[u8], budget: &Budget) -> Result<Layer, LayerParseError> {
    let mut reader = TextReader {
        file,
        bytes,
        at: 0,
        budget,
        layer: Layer::new(file),
        paths: Vec::new(),
        mistakes: Vec::new(),
        exceeded: None,
        owed: 0,
    };
    if reader.peek() == Some(b'(') {
        reader.at += 1;
        reader.metadata(MetadataOwner::Root);
    }
    reader.body(0, 0);
    if let Some(exceeded) = reader.exceeded {
        return Err(LayerParseError::Limit(exceeded));
    }
    match reader.mistakes.is_empty() {
        true => Ok(reader.layer),
        false => Err(LayerParseError::Mistakes(reader.mistakes)),
    }
}

/// Of what metadata speaks.
#[derive(Clone, Copy)]
enum MetadataOwner<'a> {
    Root,
    Prim(u32),
    Property(u32, &'a str),
}

struct TextReader<'a> {
    file: FileId,
    bytes: &'a [u8],
    at: usize,
    budget: &'a Budget,
    layer: Layer,
    /// The names of the prims around the place that is read.
    paths: Vec<String>,
    mistakes: Vec<(Span, String)>,
    exceeded: Option<LimitExceeded>,
    /// The memory that is not charged so far.
    owed: u64,
}

impl<'a> TextReader<'a> {
    /// The metadata behind an opening parenthesis.
    fn metadata(&mut self, owner: MetadataOwner<'_>) {
        let opening = self.at - 1;
        loop {
            match self.peek() {
                None => {
                    self.mistake_at(opening, "`(` is never closed");
                    return;
                }
                Some(b')') => {
                    self.at += 1;
                    return;
                }
                Some(b'"' | b'\'') => drop(self.string()),
                Some(_) => {
                    if self.entry(owner).is_none() {
                        self.skip_line();
                    }
                }
            }
        }
    }

    /// One entry of metadata.
    fn entry(&mut self, owner: MetadataOwner<'_>) -> Option<()> {
        let start = self.at;
        let mut key = self.word();
        let mut keyword = "";
        if matches!(key, "prepend" | "append" | "add" | "delete" | "reorder") {
            keyword = key;
            key = self.word();
        }
        if key.is_empty() {
            return self.mistake("the name of a metadata field is expected here");
        }
        self.expect(b'=')?;
        match owner {
            MetadataOwner::Root => self.stage_entry(key),
            MetadataOwner::Prim(index) => self.prim_entry(index, keyword, key, start),
            MetadataOwner::Property(index, name) => {
                if !matches!(key, "interpolation" | "bindMaterialAs") {
                    return self.skip_value();
                }
                let word = self.string()?;
                if let Some(property) = self.layer.prim_mut(index).properties.get_mut(name) {
                    property.describe(key, word);
                }
                Some(())
            }
        }
    }

    fn stage_entry(&mut self, key: &str) -> Option<()> {
        match key {
            "defaultPrim" => self.layer.metadata.default_prim = Some(self.string()?),
            "upAxis" => {
                let start = self.at;
                let text = self.string()?;
                let span = self.span(start);
                self.layer.metadata.up_axis = Some(SpannedText { text, span });
            }
            "relocates" => {
                self.layer.prim_mut(0).has_relocates = true;
                self.skip_value()?;
            }
            "metersPerUnit" | "timeCodesPerSecond" | "framesPerSecond" | "startTimeCode" => {
                let Value::Numbers(numbers) = self.value()? else {
                    return self.mistake("a number is expected here");
                };
                let number = numbers.first().copied();
                let metadata = &mut self.layer.metadata;
                *match key {
                    "metersPerUnit" => &mut metadata.meters_per_unit,
                    "startTimeCode" => &mut metadata.start_time_code,
                    "framesPerSecond" => &mut metadata.frames_per_second,
                    _ => &mut metadata.time_codes_per_second,
                } = number;
            }
            "subLayers" => {
                let layers = self.list(|reader| {
                    let asset = reader.between(b'@', b'@')?;
                    let time = reader.time_map()?;
                    Some(SubLayer { asset, time })
                });
                self.layer.metadata.sub_layers = layers?;
            }
            _ => self.skip_value()?,
        }
        Some(())
    }

    fn prim_entry(&mut self, index: u32, keyword: &str, key: &str, start: usize) -> Option<()> {
        // Composition arcs are edited, by the keyword, in the list of the prim.
        match key {
            "references" | "payload" => {
                let items = self.list(Self::target)?;
                let prim = self.layer.prim_mut(index);
                let list = if key == "payload" {
                    &mut prim.payloads
                } else {
                    &mut prim.references
                };
                list.edit(keyword, items);
            }
            "inherits" | "specializes" => {
                let items = self.list(|reader| Some(ArcTarget::internal(reader.path()?)))?;
                let prim = self.layer.prim_mut(index);
                let is_inherit = key == "inherits";
                let list = if is_inherit {
                    &mut prim.inherits
                } else {
                    &mut prim.specializes
                };
                list.edit(keyword, items);
            }
            "active" => {
                let value = self.value()?;
                let is_active = value == Value::Numbers(vec![1.0]);
                self.layer.prim_mut(index).is_active = Some(is_active);
            }
            "variants" => {
                self.expect(b'{')?;
                while !self.eat(b'}') {
                    self.word();
                    let set = match self.peek() {
                        Some(b'"') => self.string()?,
                        _ => self.word().to_owned(),
                    };
                    self.expect(b'=')?;
                    let variant = self.string()?;
                    self.layer.prim_mut(index).selections.insert(set, variant);
                }
            }
            "relocates" => {
                self.layer.prim_mut(index).has_relocates = true;
                self.skip_value()?;
            }
            "clips" => {
                self.layer.prim_mut(index).has_clips = true;
                self.layer.prim_mut(index).span = self.span(start);
                self.skip_value()?;
            }
            _ => self.skip_value()?,
        }
        Some(())
    }

    /// The target of a reference: `@file@</path> (offset = 1)`.
    fn target(&mut self) -> Option<ArcTarget> {
        let start = self.at;
        let asset = match self.peek() {
            Some(b'@') => self.between(b'@', b'@')?.text,
            _ => String::new(),
        };
        let path = match self.peek() {
            Some(b'<') => self.path()?.text,
            _ if asset.is_empty() => {
                return self.mistake("a file as `@file@` or a path as `</path>` is expected here");
            }
            _ => String::new(),
        };
        let span = self.span(start);
        let time = self.time_map()?;
        Some(ArcTarget {
            asset,
            path,
            time,
            span,
        })
    }

    /// `(offset = 1; scale = 2)`, or nothing.
    fn time_map(&mut self) -> Option<LayerOffset> {
        let mut time = LayerOffset::default();
        if !self.eat(b'(') {
            return Some(time);
        }
        while !self.eat(b')') {
            let key = self.word();
            self.expect(b'=')?;
            match key {
                "offset" | "scale" => {
                    let number = self.word().parse::<f64>();
                    let Ok(number) = number else {
                        return self.mistake("a number is expected here");
                    };
                    *(if key == "scale" {
                        &mut time.scale
                    } else {
                        &mut time.offset
                    }) = number;
                }
                _ => self.skip_value()?,
            }
            self.eat(b',');
        }
        Some(time)
    }

    /// The statements of a prim, to its closing brace, or to the end of the file.
    fn body(&mut self, index: u32, depth: usize) {
        let opening = self.at.saturating_sub(1);
        loop {
            match self.peek() {
                None if depth == 0 => return,
                None => {
                    self.mistake_at(opening, "`{` is never closed");
                    return;
                }
                Some(b'}') if depth > 0 => {
                    self.at += 1;
                    return;
                }
                Some(_) => {
                    let start = self.at;
                    if self.statement(index, depth).is_none() {
                        // The rest of the line is not understood.
                        self.at = self.at.max(start);
                        self.skip_line();
                    }
                }
            }
        }
    }

    fn statement(&mut self, index: u32, depth: usize) -> Option<()> {
        let start = self.at;
        let first = self.word();
        match first {
            "def" => self.prim(index, depth, Specifier::Def, start),
            "over" => self.prim(index, depth, Specifier::Over, start),
            "class" => self.prim(index, depth, Specifier::Class, start),
            "variantSet" => self.variant_set(index, depth),
            "" => self.mistake("a prim or a property is expected here"),
            "reorder" => {
                self.word();
                self.expect(b'=')?;
                self.skip_value()
            }
            _ => self.property(index, first, start),
        }
    }

    fn prim(
        &mut self,
        parent: u32,
        depth: usize,
        specifier: Specifier,
        start: usize,
    ) -> Option<()> {
        let mut type_name = String::new();
        if self.peek().is_some_and(is_name) {
            type_name = self.word().to_owned();
        }
        let name = self.string()?;
        if depth >= MAX_DEPTH {
            let message = format!("prims are nested more than {MAX_DEPTH} deep");
            self.at = start;
            self.mistake::<()>(message);
            self.at = self.bytes.len();
            return None;
        }
        self.spend(PRIM);
        let mut prim = PrimSpec::new(self.span(start));
        (prim.specifier, prim.type_name) = (specifier, type_name);
        let index = self.layer.add(prim);
        self.layer
            .prim_mut(parent)
            .children
            .insert(name.clone(), index);
        self.paths.push(name);
        self.braced(index, depth);
        self.paths.pop();
        Some(())
    }

    /// The metadata and the body of a prim or a variant.
    fn braced(&mut self, index: u32, depth: usize) {
        if self.eat(b'(') {
            self.metadata(MetadataOwner::Prim(index));
        }
        if self.expect(b'{').is_some() {
            self.body(index, depth + 1);
        }
    }

    fn variant_set(&mut self, prim: u32, depth: usize) -> Option<()> {
        let set = self.string()?;
        self.expect(b'=')?;
        self.expect(b'{')?;
        if depth + 1 >= MAX_DEPTH {
            self.mistake::<()>(format!("prims are nested more than {MAX_DEPTH} deep"));
            self.at = self.bytes.len();
            return None;
        }
        while !self.eat(b'}') {
            let start = self.at;
            let name = self.string()?;
            self.spend(PRIM);
            let index = self.layer.add(PrimSpec::new(self.span(start)));
            let variants = self.layer.prim_mut(prim).variants.entry(set.clone());
            variants.or_default().insert(name, index);
            self.braced(index, depth + 1);
        }
        Some(())
    }

    /// An attribute or a relationship; `first` is its first word.
    fn property(&mut self, index: u32, first: &'a str, start: usize) -> Option<()> {
        // Read the keywords before the type.
        let mut keyword = "";
        let mut word = first;
        loop {
            match word {
                "prepend" | "append" | "add" | "delete" => keyword = word,
                "custom" | "uniform" | "varying" | "config" => {}
                _ => break,
            }
            word = self.word();
        }
        let is_relationship = word == "rel";
        let mut kind = ValueType::of(word);
        if self.eat(b'[') {
            self.expect(b']')?;
            kind.is_array = true;
        }
        let full = self.word();
        if full.is_empty() {
            return self.mistake("the name of a property is expected here");
        }
        let (name, suffix) = full.split_once('.').unwrap_or((full, ""));
        // Store the property with its value.
        self.spend(PROPERTY + name.len() as u64);
        let span = self.span(start);
        let properties = &mut self.layer.prim_mut(index).properties;
        let property = properties.entry(name.to_owned()).or_default();
        property.span.get_or_insert(span);
        if self.eat(b'=') {
            match suffix {
                "timeSamples" => self.samples(index, name, kind)?,
                "connect" => self.targets(index, name, keyword)?,
                "" if is_relationship => self.targets(index, name, keyword)?,
                "" => {
                    let value = self.value_of(kind)?;
                    let properties = &mut self.layer.prim_mut(index).properties;
                    if let Some(property) = properties.get_mut(name) {
                        property.value = Some(StoredValue::Read(value));
                    }
                }
                _ => self.skip_value()?,
            }
        }
        if self.eat(b'(') {
            self.metadata(MetadataOwner::Property(index, name));
        }
        Some(())
    }

    fn targets(&mut self, index: u32, name: &str, keyword: &str) -> Option<()> {
        let items = self.list(Self::path)?;
        if let Some(property) = self.layer.prim_mut(index).properties.get_mut(name) {
            let targets = property.targets.get_or_insert_with(ListOp::default);
            targets.edit(keyword, items);
        }
        Some(())
    }

    fn samples(&mut self, index: u32, name: &str, kind: ValueType<'_>) -> Option<()> {
        self.expect(b'{')?;
        let mut samples: Vec<(f64, StoredValue)> = Vec::new();
        while !self.eat(b'}') {
            let start = self.at;
            // The colon is one of the bytes of a name.
            let word = self.word_of(|byte| is_name(byte) && byte != b':');
            let Ok(time) = word.parse::<f64>() else {
                self.at = start;
                return self.mistake("the time of a sample is expected here");
            };
            self.expect(b':')?;
            self.spend(WORD);
            samples.push((time, StoredValue::Read(self.value_of(kind)?)));
            if !self.eat(b',') {
                self.expect(b'}')?;
                break;
            }
        }
        samples.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(property) = self.layer.prim_mut(index).properties.get_mut(name) {
            property.samples = samples;
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_source::SourceMap;

    /// Every place for the end of a text, and for the last mistake that is kept.
    #[test]
    fn no_damaged_text_panics() {
        let text = include_str!("../../../tests/diagnostics/US001/syntax.usda").repeat(2);
        let file = SourceMap::default().add("stage.usda", Vec::new());
        for place in 0..text.len() {
            let (before, after) = text.split_at(place);
            for part in [before, after] {
                let _ = read(file, part.as_bytes(), &Budget::default());
            }
        }
    }
}
