//! An independent writer of CDR: random messages of any definition, with what a reader should find in them.

use trench_msgs::Message;
use trench_rosidl::Library;
use trench_rosidl::definition::{Base, Definition, Field, Primitive, Shape};
use trench_rosidl::dynamic::Value;

/// The definitions of a message and all that it contains.
pub(crate) fn library<M: Message>() -> Library {
    Library::from_ros2msg(M::TYPE.name, M::TYPE.definition).expect("our own definitions are understood")
}

/// The generator SplitMix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }
}

/// Writes one message.
pub(crate) struct Writer<'a> {
    library: &'a Library,
    random: Random,
    big_endian: bool,
    body: Vec<u8>,
}

impl Writer<'_> {
    /// The message with its header, and its values.
    pub(crate) fn message(library: &Library, name: &str, seed: u64, big_endian: bool) -> (Vec<u8>, Value) {
        let mut writer = Writer { library, random: Random(seed), big_endian, body: Vec::new() };
        let value = writer.structure(library.get(name).expect("a known type"));
        let mut cdr = vec![0, u8::from(!big_endian), 0, 0];
        cdr.extend(writer.body);
        (cdr, value)
    }

    fn structure(&mut self, definition: &Definition) -> Value {
        if definition.fields.is_empty() {
            self.body.push(0);
        }
        let fields = definition.fields.iter();
        Value::Message(fields.map(|field| (field.name.as_str().into(), self.field(field))).collect())
    }

    fn field(&mut self, field: &Field) -> Value {
        let random_length = self.random.next() as usize % 4;
        let length = match field.shape {
            Shape::Single => return self.element(&field.base),
            Shape::Array(length) => length,
            Shape::Sequence => random_length,
            Shape::Bounded(bound) => random_length.min(bound),
        };
        if !matches!(field.shape, Shape::Array(_)) {
            self.number(&(length as u32).to_le_bytes());
        }
        let values: Vec<Value> = (0..length).map(|_| self.element(&field.base)).collect();
        match &field.base {
            Base::Primitive(Primitive::UInt8 | Primitive::Byte) => {
                Value::Bytes(values.iter().map(|value| value.as_f64().expect("a number") as u8).collect())
            }
            _ => Value::List(values),
        }
    }

    fn element(&mut self, base: &Base) -> Value {
        match base {
            Base::Nested(name) => self.structure(self.library.get(name).expect("a known type")),
            Base::Primitive(primitive) => self.primitive(*primitive),
            Base::String { .. } | Base::WideString { .. } => {
                let text = ["", "x", "map", "träger", "robot12/odom"][self.random.next() as usize % 5];
                self.number(&(text.len() as u32 + 1).to_le_bytes());
                self.body.extend(text.bytes());
                self.body.push(0);
                Value::Text(text.to_owned())
            }
        }
    }

    fn primitive(&mut self, primitive: Primitive) -> Value {
        let bits = self.random.next();
        let real = (bits as i32) as f64 / 1024.0;
        let (bytes, value) = match primitive {
            Primitive::Bool => (vec![bits as u8 & 1], Value::Bool(bits & 1 == 1)),
            Primitive::Byte | Primitive::UInt8 => (vec![bits as u8], Value::Unsigned((bits as u8).into())),
            Primitive::UInt16 => ((bits as u16).to_le_bytes().to_vec(), Value::Unsigned((bits as u16).into())),
            Primitive::UInt32 => ((bits as u32).to_le_bytes().to_vec(), Value::Unsigned((bits as u32).into())),
            Primitive::UInt64 => (bits.to_le_bytes().to_vec(), Value::Unsigned(bits)),
            Primitive::Int8 => (vec![bits as u8], Value::Integer((bits as i8).into())),
            Primitive::Int16 => ((bits as i16).to_le_bytes().to_vec(), Value::Integer((bits as i16).into())),
            Primitive::Int32 => ((bits as i32).to_le_bytes().to_vec(), Value::Integer((bits as i32).into())),
            Primitive::Int64 => (bits.to_le_bytes().to_vec(), Value::Integer(bits as i64)),
            Primitive::Float32 => ((real as f32).to_le_bytes().to_vec(), Value::Float32(real as f32)),
            Primitive::Float64 => (real.to_le_bytes().to_vec(), Value::Float64(real)),
        };
        self.number(&bytes);
        value
    }

    /// Little-endian bytes, aligned to their number, in the order asked for.
    fn number(&mut self, bytes: &[u8]) {
        while !self.body.len().is_multiple_of(bytes.len()) {
            self.body.push(0);
        }
        let ordered: Vec<u8> = if self.big_endian { bytes.iter().rev().copied().collect() } else { bytes.to_vec() };
        self.body.extend(ordered);
    }
}
