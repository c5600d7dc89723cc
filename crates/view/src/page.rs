//! The page, all of it inside the program: it works without any other host.

/// One file of the page.
#[derive(Debug, Clone, Copy)]
pub struct File {
    /// Its path in the address, with the leading slash.
    pub path: &'static str,
    /// For the header of that name.
    pub content_type: &'static str,
    /// What is in it.
    pub bytes: &'static [u8],
}

/// What the page may do: load its own files, speak with its own server, nothing else.
pub const CONTENT_SECURITY_POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; font-src 'self'; \
     img-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

macro_rules! files {
    ($($path:literal => $file:literal, $content_type:expr;)*) => {
        &[$(File { path: $path, content_type: $content_type, bytes: include_bytes!(concat!("../page/", $file)) }),*]
    };
}

const HTML: &str = "text/html; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";
const SVG: &str = "image/svg+xml";
const FONT: &str = "font/woff2";

/// Of all pages. `vendor/` is what `scripts/view-vendor` brings from npm.
pub const SHARED: &[File] = files! {
    "/style.css" => "style.css", STYLE;
    "/icon.svg" => "icon.svg", SVG;
    "/theme.js" => "theme.js", SCRIPT;
    "/vendor/inter.woff2" => "vendor/inter.woff2", FONT;
};

/// The page of `trench view`.
pub const FIELD: &[File] = files! {
    "/" => "index.html", HTML;
    "/main.js" => "main.js", SCRIPT;
    "/connection.js" => "connection.js", SCRIPT;
    "/picture.js" => "picture.js", SCRIPT;
    "/field.js" => "field.js", SCRIPT;
    "/robots.js" => "robots.js", SCRIPT;
    "/shapes.js" => "shapes.js", SCRIPT;
    "/trails.js" => "trails.js", SCRIPT;
    "/cards.js" => "cards.js", SCRIPT;
    "/bar.js" => "bar.js", SCRIPT;
    "/layers.js" => "layers.js", SCRIPT;
    "/vendor/d3.min.js" => "vendor/d3.min.js", SCRIPT;
};

/// The page of `trench calibrate live`.
pub const COLOURS: &[File] = files! {
    "/" => "colours/index.html", HTML;
    "/colours.css" => "colours/colours.css", STYLE;
    "/colours.js" => "colours/colours.js", SCRIPT;
    "/panel.js" => "colours/panel.js", SCRIPT;
    "/camera.js" => "colours/camera.js", SCRIPT;
    "/stream.js" => "colours/stream.js", SCRIPT;
};

#[cfg(test)]
mod tests {
    use super::*;
    use sha2::{Digest, Sha256};
    use std::path::Path;

    /// Every file of a folder is one of `files`, or of those that all pages share.
    fn check(folder: &str, files: &[File]) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            if path.is_dir() {
                continue;
            }
            let served = if name == "index.html" { "/".to_owned() } else { format!("/{name}") };
            let is_it = |file: &&File| file.path == served && file.bytes == std::fs::read(&path).unwrap();
            let file = files.iter().chain(SHARED).find(is_it).unwrap_or_else(|| panic!("{served} is not served"));
            let text = std::str::from_utf8(file.bytes).unwrap();
            let own = text.replace("http://www.w3.org/2000/svg", "").replace("ws://${location.host}/", "");
            assert!(!own.contains("://"), "{name} names another host");
        }
    }

    #[test]
    fn every_file_of_a_page_is_served_and_names_no_other_host() {
        check("page", FIELD);
        check("page/colours", COLOURS);
        for page in [FIELD, COLOURS] {
            let mut paths: Vec<&str> = page.iter().chain(SHARED).map(|file| file.path).collect();
            let count = paths.len();
            paths.sort_unstable();
            paths.dedup();
            assert_eq!(paths.len(), count, "two files have one path");
        }
    }

    /// Each file that came from npm is, byte for byte, what scripts/view-vendor wrote down, and none is there that it did not.
    #[test]
    fn vendored_files_are_those_that_were_written_down() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("page/vendor");
        let list = std::fs::read_to_string(folder.join("VERSIONS")).unwrap();
        let lines = list.lines().filter(|line| !line.starts_with('#'));
        let mut written: Vec<(&str, &str)> =
            lines.map(|line| line.split_once("  ").unwrap()).map(|(hash, name)| (name, hash)).collect();
        written.sort_unstable();
        let names = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut found: Vec<String> = names.filter(|name| name != "VERSIONS").collect();
        found.sort_unstable();
        assert_eq!(found, written.iter().map(|(name, _)| *name).collect::<Vec<_>>());
        for name in ["d3.min.js", "d3.LICENSE", "inter.woff2", "inter.LICENSE"] {
            assert!(found.iter().any(|found| found == name), "{name}");
        }
        for (name, hash) in written {
            let bytes = std::fs::read(folder.join(name)).unwrap();
            let own: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
            assert_eq!(own, hash, "{name}");
        }
    }
}
