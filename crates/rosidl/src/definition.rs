//! What a parsed definition consists of.

pub use crate::primitive::Primitive;

/// The `package/msg/Name` of a type.
pub type TypeName = String;

/// A message type, or one half of a service.
#[derive(Debug, Clone, PartialEq)]
pub struct Definition {
    /// For example `geometry_msgs/msg/Pose` or `std_srvs/srv/Trigger_Request`.
    pub name: TypeName,
    /// The comment at the head of the text.
    pub comment: Vec<String>,
    /// In the order of the text.
    pub constants: Vec<Constant>,
    /// In the order of the text, which is the order on the wire.
    pub fields: Vec<Field>,
    /// The text itself.
    pub text: String,
}

/// A service type as parsed: its two halves.
#[derive(Debug, Clone, PartialEq)]
pub struct Service {
    /// For example `std_srvs/srv/Trigger`.
    pub name: TypeName,
    /// The comment at the head of the text.
    pub comment: Vec<String>,
    /// The part above the `---`.
    pub request: Definition,
    /// The part below the `---`.
    pub response: Definition,
}

/// `uint8 KIND_LINE=0`.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// For example `KIND_LINE`.
    pub name: String,
    /// Its type, never [`Base::Nested`].
    pub base: Base,
    /// Its value, of that type.
    pub value: Literal,
    /// The comment above and behind it.
    pub comment: Vec<String>,
}

/// `float64[9] pose_covariance`.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// For example `pose_covariance`.
    pub name: String,
    /// The type of one element.
    pub base: Base,
    /// How many elements.
    pub shape: Shape,
    /// The value before anything is assigned, where the text gives one.
    pub default: Option<Literal>,
    /// The comment above and behind it.
    pub comment: Vec<String>,
}

/// The type of one element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Base {
    /// A number or a boolean.
    Primitive(Primitive),
    /// `string` or `string<=N`.
    String {
        /// The most bytes it may hold.
        bound: Option<usize>,
    },
    /// `wstring` or `wstring<=N`.
    WideString {
        /// The most characters it may hold.
        bound: Option<usize>,
    },
    /// Another message.
    Nested(TypeName),
}

/// How many elements a field holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// One.
    Single,
    /// `[N]`: always N.
    Array(usize),
    /// `[]`: any number.
    Sequence,
    /// `[<=N]`: up to N.
    Bounded(usize),
}

/// A value in the text: of a constant or a default.
#[derive(Debug, Clone, PartialEq)]
pub enum Literal {
    /// `true` or `false`.
    Bool(bool),
    /// Any integer type.
    Integer(i128),
    /// Either floating-point type.
    Float(f64),
    /// Without its quotes.
    Text(String),
    /// `[1, 2, 3]`.
    List(Vec<Literal>),
}

/// The name of the one field that a definition without fields has on the wire: C has no empty structures.
pub const PLACEHOLDER: &str = "structure_needs_at_least_one_member";

impl Definition {
    /// `geometry_msgs` of `geometry_msgs/msg/Pose`.
    #[must_use]
    pub fn package(&self) -> &str {
        package_of(&self.name)
    }

    /// The messages its fields name, in the order of the text, with repetitions.
    pub fn references(&self) -> impl Iterator<Item = &str> {
        self.fields.iter().filter_map(|field| match &field.base {
            Base::Nested(name) => Some(name.as_str()),
            _ => None,
        })
    }
}

/// `geometry_msgs` of `geometry_msgs/msg/Pose`.
#[must_use]
pub fn package_of(name: &str) -> &str {
    name.split('/').next().unwrap_or_default()
}

/// `Pose` of `geometry_msgs/msg/Pose`.
#[must_use]
pub fn short_name_of(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or_default()
}
