//! Element layouts: the type of a component, and the rows and columns of an element.

/// The type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ComponentType {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl ComponentType {
    pub(super) fn from_code(code: u64) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    /// Its size in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The least and the greatest value of an integer type.
    pub(super) fn range(self) -> Option<[f64; 2]> {
        Some(match self {
            Self::I8 => [f64::from(i8::MIN), f64::from(i8::MAX)],
            Self::U8 => [0.0, f64::from(u8::MAX)],
            Self::I16 => [f64::from(i16::MIN), f64::from(i16::MAX)],
            Self::U16 => [0.0, f64::from(u16::MAX)],
            Self::U32 => [0.0, f64::from(u32::MAX)],
            Self::F32 => return None,
        })
    }

    /// True if indices may be of the type.
    pub(super) fn is_index(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::I8 => "i8",
            Self::U8 => "u8",
            Self::I16 => "i16",
            Self::U16 => "u16",
            Self::U32 => "u32",
            Self::F32 => "f32",
        }
    }
}

/// The layout of an element: columns of components, each column of a matrix starting at a multiple
/// of four bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ElementLayout {
    pub(super) component: ComponentType,
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Integers are fractions of the largest value.
    pub(super) normalized: bool,
}

impl ElementLayout {
    /// The number of components of an element.
    pub(super) fn components(self) -> usize {
        self.columns * self.rows
    }

    /// Bytes from one column to the next.
    pub(super) fn column(self) -> usize {
        let bytes = self.rows * self.component.size();
        if self.columns > 1 {
            bytes.next_multiple_of(4)
        } else {
            bytes
        }
    }

    /// The stride of tightly packed elements, in bytes.
    pub(super) fn packed(self) -> usize {
        self.columns * self.column()
    }

    /// The bytes of an element without padding.
    pub(super) fn size(self) -> usize {
        self.packed() - self.column() + self.rows * self.component.size()
    }

    /// True if the numbers can be a bound of the elements.
    pub(super) fn is_bound(self, bound: &[f64]) -> bool {
        let [least, most] = self
            .component
            .range()
            .unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let is_whole = |number: f64| self.component == ComponentType::F32 || number.fract() == 0.0;
        bound.len() == self.components()
            && bound
                .iter()
                .all(|number| is_whole(*number) && (least..=most).contains(number))
    }

    /// As messages call it: `vec3 of f32`.
    pub(super) fn name(self) -> String {
        let shape = match (self.columns, self.rows) {
            (1, 1) => "scalar".to_owned(),
            (1, rows) => format!("vec{rows}"),
            (columns, _) => format!("mat{columns}"),
        };
        format!(
            "{shape} of {}{}",
            if self.normalized { "normalised " } else { "" },
            self.component.name()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_matrices_are_padded_as_the_specification_says() {
        let layout = |component, columns, rows| ElementLayout {
            component,
            columns,
            rows,
            normalized: false,
        };
        let sizes = |component, columns, rows| {
            let layout = layout(component, columns, rows);
            (layout.size(), layout.packed())
        };
        assert_eq!(sizes(ComponentType::U8, 2, 2), (6, 8));
        assert_eq!(sizes(ComponentType::I8, 3, 3), (11, 12));
        assert_eq!(sizes(ComponentType::U16, 3, 3), (22, 24));
        assert_eq!(sizes(ComponentType::U16, 2, 2), (8, 8));
        assert_eq!(sizes(ComponentType::F32, 4, 4), (64, 64));
        assert_eq!(sizes(ComponentType::U8, 1, 3), (3, 3));
    }
}
