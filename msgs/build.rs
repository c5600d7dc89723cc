//! Generates the Rust types of all definitions below `msg/`, `srv/` and `standard/`.

use std::path::{Path, PathBuf};
use trench_rosidl::{Library, Settings, generate, parse_message, parse_service};

/// The package of `msg/` and `srv/`.
const OWN_PACKAGE: &str = "trench_msgs";
/// Messages that are read in place.
const VIEWS: [&str; 3] = ["sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "trench_msgs/msg/LeaderState"];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut library = Library::default();
    read_package(Path::new("."), OWN_PACKAGE, &mut library)?;
    for package in entries(Path::new("standard"))? {
        read_package(&package, &name_of(&package), &mut library)?;
    }
    // Cargo would take a folder that is not there for changed, every time.
    for folder in ["msg", "srv", "standard"].into_iter().filter(|folder| Path::new(folder).exists()) {
        println!("cargo::rerun-if-changed={folder}");
    }
    let source = generate(&library, &Settings { own_package: OWN_PACKAGE, views: &VIEWS })?;
    let target = std::env::var_os("OUT_DIR").ok_or("cargo sets OUT_DIR")?;
    std::fs::write(Path::new(&target).join("messages.rs"), source)?;
    Ok(())
}

fn read_package(folder: &Path, package: &str, library: &mut Library) -> Result<(), Box<dyn std::error::Error>> {
    for kind in ["msg", "srv"] {
        for file in entries(&folder.join(kind))? {
            let name = format!("{package}/{kind}/{}", name_of(&file));
            let text = std::fs::read_to_string(&file)?;
            match kind {
                "msg" => library.add_message(parse_message(&name, &text)?)?,
                _ => library.add_service(parse_service(&name, &text)?)?,
            }
        }
    }
    Ok(())
}

/// What a folder holds, in order of name; nothing if it does not exist.
fn entries(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let mut paths =
        std::fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect::<Result<Vec<_>, _>>()?;
    paths.sort();
    Ok(paths)
}

fn name_of(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
