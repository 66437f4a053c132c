//! Facts about a map in its file.

/// A fact about a map, written into its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// ASCII, at most 255 bytes.
    pub name: String,
    /// The text or number.
    pub value: AttributeValue,
}

/// The value of an [`Attribute`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AttributeValue {
    /// Any text, stored as UTF-8.
    Text(String),
    /// A whole number; stored as text where it has more than the 32 bits of an EXR integer.
    Integer(i64),
}

impl Attribute {
    /// An attribute with a text.
    pub fn text(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), value: AttributeValue::Text(text.into()) }
    }

    /// An attribute with a whole number.
    pub fn integer(name: impl Into<String>, number: impl Into<i64>) -> Self {
        Self { name: name.into(), value: AttributeValue::Integer(number.into()) }
    }
}
