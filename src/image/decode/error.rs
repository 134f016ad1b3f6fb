//! Why a file can't be read as a picture.

use std::fmt;

/// Why a file can't be read as a picture; prints as a clause about the file.
#[derive(Debug)]
pub enum DecodeError {
    /// It is no picture, or of a format that is not read, which then is named.
    Format(Option<&'static str>),
    /// It has more pixels than it may have, or than there is memory for.
    TooLarge {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// It is of a kind that is not read, with its noun.
    Unsupported(&'static str),
    /// It is damaged; with the message of the decoder.
    Damaged(String),
}

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Format(None) => f.write_str("is not a picture"),
            Self::Format(Some(name)) => write!(f, "is a {name} file"),
            Self::Unsupported(kind) => write!(f, "is a {kind}, which is not supported"),
            Self::TooLarge { width, height } => write!(f, "has {width} × {height} pixels"),
            Self::Damaged(words) => write!(f, "is damaged: {words}"),
        }
    }
}

impl DecodeError {
    pub(crate) fn damaged(words: impl fmt::Display) -> Self {
        Self::Damaged(words.to_string().trim_end_matches('.').to_owned())
    }
}
