//! The known name that a user probably meant.

/// The candidate nearest to `name`, if any is near enough to be a slip of the fingers: at most a third of the letters
/// differ (a swap of two neighbours counts once).
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = (name.chars().count() / 3).max(1);
    candidates
        .into_iter()
        .map(|candidate| (strsim::damerau_levenshtein(name, candidate), candidate))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// A remedy for an unknown name: the nearest known one, else all known ones.
pub fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str> + Clone) -> String {
    if let Some(candidate) = nearest(name, candidates.clone()) {
        return format!("did you mean `{candidate}`?");
    }
    let mut known: Vec<&str> = candidates.into_iter().collect();
    known.sort_unstable();
    if known.is_empty() { "nothing is allowed here".to_owned() } else { format!("known are: {}", known.join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_slips_only() {
        let known = ["share", "shape", "tolerance", "x"];
        for (name, expected) in
            [("shrae", Some("share")), ("tolerence", Some("tolerance")), ("y", Some("x")), ("vertices", None)]
        {
            assert_eq!(nearest(name, known), expected, "{name}");
        }
    }

    #[test]
    fn lists_all_when_none_is_near() {
        assert_eq!(did_you_mean("vertices", ["share", "line"]), "known are: line, share");
        assert_eq!(did_you_mean("vertices", []), "nothing is allowed here");
    }
}
