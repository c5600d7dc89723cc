//! The form in which bags carry definitions: the .msg text, then each dependency behind a line of 80 `=` and a line
//! `MSG: package/Type`.

use crate::definition::{package_of, short_name_of};
use crate::{Error, Library, parse_message};

/// The length of the line between definitions; some writers make it longer.
const SEPARATOR: usize = 80;

impl Library {
    /// A message with all that it contains in one text.
    ///
    /// # Errors
    /// When something it contains is missing.
    pub fn ros2msg(&self, name: &str) -> Result<String, Error> {
        let closure = self.closure(name)?;
        let Some((root, dependencies)) = closure.split_last() else {
            return Err(Error::Name(name.to_owned()));
        };
        let mut text = root.text.trim_end().to_owned() + "\n";
        for dependency in dependencies {
            let (package, short) = (package_of(&dependency.name), short_name_of(&dependency.name));
            let (line, body) = ("=".repeat(SEPARATOR), dependency.text.trim_end());
            text += &format!("{line}\nMSG: {package}/{short}\n{body}\n");
        }
        Ok(text)
    }

    /// The definitions in one text; `name` is the first one's, for example `nav_msgs/msg/Odometry`.
    ///
    /// # Errors
    /// When a part is not understood.
    pub fn from_ros2msg(name: &str, text: &str) -> Result<Self, Error> {
        let mut library = Self::default();
        let mut parts = vec![(full_name(name)?, String::new())];
        let mut lines = text.lines().enumerate();
        while let Some((_, line)) = lines.next() {
            if line.len() >= SEPARATOR && line.trim_end().bytes().all(|byte| byte == b'=') {
                let (index, line) = lines.next().unwrap_or_default();
                let problem = || Error::Syntax {
                    name: name.to_owned(),
                    line: index + 1,
                    problem: format!("`MSG: package/Type` is expected behind a line of `=`, not `{line}`"),
                };
                let part = line.strip_prefix("MSG:").ok_or_else(problem)?;
                parts.push((full_name(part.trim())?, String::new()));
            } else if let Some((_, text)) = parts.last_mut() {
                text.push_str(line);
                text.push('\n');
            }
        }
        for (part, text) in parts {
            // Some recorders repeat dependencies.
            if library.get(&part).is_none() {
                library.add_message(parse_message(&part, &text)?)?;
            }
        }
        Ok(library)
    }
}

/// `package/msg/Name` of `package/Name` or itself.
pub(crate) fn full_name(name: &str) -> Result<String, Error> {
    match name.split('/').collect::<Vec<_>>()[..] {
        [package, short] => Ok(format!("{package}/msg/{short}")),
        [_, _, _] => Ok(name.to_owned()),
        _ => Err(Error::Name(name.to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_of_a_library_is_read_back() {
        let line = "=".repeat(SEPARATOR);
        let text = format!("# A.\nB b\n{line}\nMSG: p/B\nq/C c\n{line}\nMSG: q/C\nuint8 x\n");
        let library = Library::from_ros2msg("p/msg/A", &text).expect("valid");
        let again = library.ros2msg("p/msg/A").expect("complete");
        assert_eq!(Library::from_ros2msg("p/A", &again).expect("valid").hash("p/msg/A"), library.hash("p/msg/A"));
        assert_eq!(library.definitions().count(), 3);
    }

    #[test]
    fn a_repeated_dependency_is_taken_once() {
        let line = "=".repeat(SEPARATOR);
        let text = format!("B b\n{line}\nMSG: p/msg/B\nuint8 x\n{line}\nMSG: p/B\nuint8 x\n");
        assert_eq!(Library::from_ros2msg("p/msg/A", &text).map(|library| library.definitions().count()), Ok(2));
    }

    #[test]
    fn what_is_no_part_is_named() {
        let line = "=".repeat(SEPARATOR);
        let error = Library::from_ros2msg("p/msg/A", &format!("uint8 x\n{line}\nIDL: p/B\n")).expect_err("no part");
        let expected = "p/msg/A, line 3: `MSG: package/Type` is expected behind a line of `=`, not `IDL: p/B`";
        assert_eq!(error.to_string(), expected);
        let error = Library::from_ros2msg("p/msg/A", &line).expect_err("no part");
        assert!(error.to_string().ends_with("not ``"), "{error}");
    }
}
