//! A reader's name in shared memory: who it is on the network.

use iceoryx2::port::port_name::PortName;

/// The name of the reader that is `gid` on the network.
pub(super) fn name(gid: [u8; 16]) -> Result<PortName, String> {
    let text: String = gid.iter().map(|byte| format!("{byte:02x}")).collect();
    PortName::new(&text).map_err(|error| format!("{error:?}"))
}

/// Who a reader is; nothing if its name is none of ours.
pub(super) fn gid(name: &PortName) -> Option<[u8; 16]> {
    let text = Some(name.as_str()).filter(|text| text.len() == 32)?;
    let byte = |index: usize| u8::from_str_radix(text.get(2 * index..2 * index + 2)?, 16).ok();
    let mut gid = [0; 16];
    for (index, place) in gid.iter_mut().enumerate() {
        *place = byte(index)?;
    }
    Some(gid)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_who_it_is() {
        let reader = std::array::from_fn(|index| 17 * index as u8);
        assert_eq!(gid(&name(reader).unwrap()), Some(reader));
        for foreign in ["", "camera", "00112233445566778899aabbccddeefg"] {
            assert_eq!(gid(&PortName::new(foreign).unwrap()), None);
        }
    }
}
