//! Prints the RIHS01 hash of every message and service as JSON.

fn main() {
    let types = trench_msgs::types().iter().map(|info| (info.name, info.hash));
    let services = trench_msgs::services().iter().map(|info| (info.name, info.hash));
    let mut hashes: Vec<_> = types.chain(services).collect();
    hashes.sort_unstable();
    let lines: Vec<String> = hashes.iter().map(|(name, hash)| format!(" \"{name}\": \"{hash}\"")).collect();
    println!("{{\n{}\n}}", lines.join(",\n"));
}
