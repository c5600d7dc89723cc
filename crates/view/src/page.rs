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

/// All files. `vendor/` is what `scripts/view-vendor` brings from npm.
pub const FILES: &[File] = files! {
    "/" => "index.html", HTML;
    "/style.css" => "style.css", STYLE;
    "/icon.svg" => "icon.svg", SVG;
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
    "/vendor/inter.woff2" => "vendor/inter.woff2", FONT;
};

/// The file at this path.
#[must_use]
pub fn find(path: &str) -> Option<&'static File> {
    FILES.iter().find(|file| file.path == path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_file_of_the_page_is_served_and_names_no_other_host() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("page");
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            if path.is_dir() {
                continue;
            }
            let served = if name == "index.html" { "/".to_owned() } else { format!("/{name}") };
            let file = find(&served).unwrap_or_else(|| panic!("{served} is not served"));
            let text = std::str::from_utf8(file.bytes).unwrap();
            let own = text.replace("http://www.w3.org/2000/svg", "").replace("ws://${location.host}/", "");
            assert!(!own.contains("://"), "{name} names another host");
        }
        assert!(find("/../Cargo.toml").is_none() && find("/vendor/").is_none());
    }

    /// The page's own hash of each file that came from npm is what scripts/view-vendor wrote down.
    #[test]
    fn vendored_files_have_their_licences() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("page/vendor");
        let list = std::fs::read_to_string(folder.join("VERSIONS")).unwrap();
        for name in ["d3.min.js", "inter.woff2"] {
            assert!(list.contains(name), "{name}");
        }
        assert!(folder.join("d3.LICENSE").exists() && folder.join("inter.LICENSE").exists());
    }
}
