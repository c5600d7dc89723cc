//! What a parsed definition consists of.

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

/// Numbers and booleans. `char` is an unsigned byte in ROS 2 and parsed as [`Primitive::UInt8`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "each variant is the primitive type of its name")]
pub enum Primitive {
    Bool,
    Byte,
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Int64,
    UInt64,
    Float32,
    Float64,
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

impl Primitive {
    /// Its size and its alignment in CDR, in bytes.
    #[must_use]
    pub const fn size(self) -> usize {
        match self {
            Self::Bool | Self::Byte | Self::Int8 | Self::UInt8 => 1,
            Self::Int16 | Self::UInt16 => 2,
            Self::Int32 | Self::UInt32 | Self::Float32 => 4,
            Self::Int64 | Self::UInt64 | Self::Float64 => 8,
        }
    }

    /// Its name in a definition.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::Byte => "byte",
            Self::Int8 => "int8",
            Self::UInt8 => "uint8",
            Self::Int16 => "int16",
            Self::UInt16 => "uint16",
            Self::Int32 => "int32",
            Self::UInt32 => "uint32",
            Self::Int64 => "int64",
            Self::UInt64 => "uint64",
            Self::Float32 => "float32",
            Self::Float64 => "float64",
        }
    }

    /// The type of this name in a definition.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "bool" => Self::Bool,
            "byte" => Self::Byte,
            "int8" => Self::Int8,
            "uint8" | "char" => Self::UInt8,
            "int16" => Self::Int16,
            "uint16" => Self::UInt16,
            "int32" => Self::Int32,
            "uint32" => Self::UInt32,
            "int64" => Self::Int64,
            "uint64" => Self::UInt64,
            "float32" => Self::Float32,
            "float64" => Self::Float64,
            _ => return None,
        })
    }

    /// The least and the greatest value of an integer type.
    #[must_use]
    pub const fn integer_range(self) -> Option<(i128, i128)> {
        Some(match self {
            Self::Byte | Self::UInt8 => (0, u8::MAX as i128),
            Self::Int8 => (i8::MIN as i128, i8::MAX as i128),
            Self::Int16 => (i16::MIN as i128, i16::MAX as i128),
            Self::UInt16 => (0, u16::MAX as i128),
            Self::Int32 => (i32::MIN as i128, i32::MAX as i128),
            Self::UInt32 => (0, u32::MAX as i128),
            Self::Int64 => (i64::MIN as i128, i64::MAX as i128),
            Self::UInt64 => (0, u64::MAX as i128),
            Self::Bool | Self::Float32 | Self::Float64 => return None,
        })
    }
}

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
