//! One message: its structure, constants, first values and encoding.

use super::{Context, documentation, rust_type};
use crate::Error;
use crate::definition::{Base, Constant, Definition, Field, Shape};

pub(super) fn generate(context: &Context, definition: &Definition) -> Result<String, Error> {
    let name = rust_type::short(&definition.name);
    let types: Vec<String> =
        definition.fields.iter().map(|field| rust_type::owned(context, definition, field)).collect::<Result<_, _>>()?;
    let mut source = structure(definition, &name, "", is_plain(context, definition), &types);
    source += &constants(&name, &definition.constants);
    source += &default(&name, definition);
    source += &codec(definition, &name, "", &types);
    source += &encode(&name, &format!("<{name} as crate::Message>::TYPE"), "");
    let (type_name, hash, text) =
        (&definition.name, context.library.hash(&definition.name)?, context.library.ros2msg(&definition.name)?);
    source += &format!(
        "impl crate::Message for {name} {{
    const TYPE: &'static crate::TypeInfo =
        &crate::TypeInfo {{ name: {type_name:?}, hash: {hash:?}, definition: {text:?} }};

    fn decode(cdr: &[u8]) -> ::std::result::Result<Self, crate::cdr::CdrError> {{
        crate::cdr::decode(cdr)
    }}
}}

"
    );
    Ok(source)
}

/// The structure itself; `life` is `<'a>` for borrowed forms.
pub(super) fn structure(definition: &Definition, name: &str, life: &str, copy: bool, types: &[String]) -> String {
    let place = if life.is_empty() { "" } else { ", its strings and bytes in place" };
    let fallback = format!("`{}`{place}.", definition.name);
    let mut source = documentation::lines(&definition.comment, &fallback, "");
    let copy = if copy { "Copy, " } else { "" };
    let default = if rust_type::default_is_derivable(definition) { ", Default" } else { "" };
    source += &format!("#[derive(Debug, Clone, {copy}PartialEq{default})]\npub struct {name}{life} {{\n");
    for (field, rust) in definition.fields.iter().zip(types) {
        source += &documentation::lines(&field.comment, &format!("`{}`.", field.name), "    ");
        source += &format!("    pub {}: {rust},\n", rust_type::field_name(&field.name));
    }
    source + "}\n\n"
}

/// Whether all values of the message have one size: then it is as good to copy as a number.
fn is_plain(context: &Context, definition: &Definition) -> bool {
    definition.fields.iter().all(|field| is_plain_field(context, field))
}

/// Whether all values of the field have one size.
pub(super) fn is_plain_field(context: &Context, field: &Field) -> bool {
    let plain = match &field.base {
        Base::Primitive(_) => true,
        Base::String { .. } | Base::WideString { .. } => false,
        Base::Nested(name) => context.library.get(name).is_some_and(|nested| is_plain(context, nested)),
    };
    plain && matches!(field.shape, Shape::Single | Shape::Array(_))
}

fn constants(name: &str, constants: &[Constant]) -> String {
    if constants.is_empty() {
        return String::new();
    }
    let mut source = format!("impl {name} {{\n");
    for constant in constants {
        let rust = match constant.base {
            Base::Primitive(primitive) => rust_type::primitive(primitive),
            _ => "&'static str",
        };
        source += &documentation::lines(&constant.comment, &format!("`{}`.", constant.name), "    ");
        source += &format!("    pub const {}: {rust} = {};\n", constant.name, rust_type::literal(&constant.value));
    }
    source + "}\n\n"
}

fn default(name: &str, definition: &Definition) -> String {
    if rust_type::default_is_derivable(definition) {
        return String::new();
    }
    let values = definition
        .fields
        .iter()
        .map(|field| format!("            {}: {},\n", rust_type::field_name(&field.name), rust_type::default(field)));
    let values: String = values.collect();
    format!(
        "impl ::std::default::Default for {name} {{
    fn default() -> Self {{
        Self {{
{values}        }}
    }}
}}

"
    )
}

/// `WriteCdr` and `ReadCdr`; `life` is `<'a>` for borrowed forms.
pub(super) fn codec(definition: &Definition, name: &str, life: &str, types: &[String]) -> String {
    let mut write = String::new();
    let mut read = String::new();
    let mut smallest = Vec::new();
    for (field, rust) in definition.fields.iter().zip(types) {
        let member = rust_type::field_name(&field.name);
        let label = format!("{}.{}", rust_type::short(&definition.name), field.name);
        write += &format!("        {}\n", write_field(field, &member));
        read += &format!("            {member}: {},\n", read_field(field, rust, &label));
        smallest.push(format!("<{rust} as crate::cdr::ReadCdr<'a>>::SMALLEST"));
    }
    if definition.fields.is_empty() {
        // C has no empty structures: ROS 2 puts a byte there.
        write = "        crate::cdr::WriteCdr::write(&0_u8, out);\n".to_owned();
        read = format!("        <u8 as crate::cdr::ReadCdr<'a>>::read(reader, \"{name}\")?;\n        Ok(Self {{}})\n");
        smallest.push("1".to_owned());
    } else {
        read = format!("        Ok(Self {{\n{read}        }})\n");
    }
    format!(
        "impl{life} crate::cdr::WriteCdr for {name}{life} {{
    fn write(&self, out: &mut impl crate::cdr::Output) {{
{write}    }}
}}

impl<'a> crate::cdr::ReadCdr<'a> for {name}{life} {{
    const SMALLEST: usize = {};

    fn read(
        reader: &mut crate::cdr::Reader<'a>,
        _: &'static str,
    ) -> ::std::result::Result<Self, crate::cdr::CdrError> {{
{read}    }}
}}

",
        smallest.join("\n        + ")
    )
}

fn write_field(field: &Field, member: &str) -> String {
    match (&field.base, field.shape) {
        (_, Shape::Bounded(bound)) => format!("crate::cdr::write_bounded(&self.{member}, {bound}, out);"),
        (Base::String { bound: Some(bound) }, Shape::Single) => {
            format!("crate::cdr::write_bounded_string(&self.{member}, {bound}, out);")
        }
        _ => format!("crate::cdr::WriteCdr::write(&self.{member}, out);"),
    }
}

fn read_field(field: &Field, rust: &str, label: &str) -> String {
    match (&field.base, field.shape) {
        (_, Shape::Bounded(bound)) => format!("crate::cdr::read_bounded(reader, {bound}, {label:?})?"),
        (Base::String { bound: Some(bound) }, Shape::Single) => {
            format!("crate::cdr::read_bounded_string(reader, {bound}, {label:?})?.into()")
        }
        _ => format!("<{rust} as crate::cdr::ReadCdr<'a>>::read(reader, {label:?})?"),
    }
}

/// `Encode`, which publishers take.
pub(super) fn encode(name: &str, type_info: &str, life: &str) -> String {
    format!(
        "impl{life} crate::Encode for {name}{life} {{
    fn type_info(&self) -> &'static crate::TypeInfo {{
        {type_info}
    }}

    fn encoded_len(&self) -> usize {{
        crate::cdr::encoded_len(self)
    }}

    fn encode_into(&self, out: &mut [u8]) -> usize {{
        crate::cdr::encode_into(self, out)
    }}
}}

"
    )
}
