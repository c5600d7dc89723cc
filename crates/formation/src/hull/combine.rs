//! Combined apparent obstacles (7.7), (7.8): everything nearer to each other than the clearance becomes one hull.
//!
//! Separations are those between hulls, and combining is repeated until no two hulls are nearer than the clearance: a
//! combined hull may come near to what neither member is near to. The fixpoint is unique, as hulls only grow, so the
//! result depends on the set of obstacles alone.
use super::{HullError, Shape, shape::length};

/// An obstacle with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// Unlike any other's.
    pub id: u32,
    /// Its own convex hull.
    pub shape: Shape,
}

/// A (combined) apparent obstacle.
#[derive(Debug, Clone, PartialEq)]
pub struct ApparentObstacle {
    /// The least id of the members: it stays while the same members stay together.
    pub id: u32,
    /// Ids of the members, ascending.
    pub members: Vec<u32>,
    /// Convex hull of all members.
    pub shape: Shape,
}

/// A hull on the way to the fixpoint.
struct Group {
    /// Indices of members, ascending.
    members: Vec<usize>,
    shape: Shape,
    low: [f64; 2],
    high: [f64; 2],
    /// Whether it was formed in the last round: only then can it have new neighbours.
    fresh: bool,
}

/// Combines obstacles whose hulls are separated by strictly less than `clearance` (m); by ascending id.
///
/// # Errors
/// A clearance that is negative or not finite; two obstacles of one id.
pub fn combine(obstacles: &[Obstacle], clearance: f64) -> Result<Vec<ApparentObstacle>, HullError> {
    combine_unless(obstacles, clearance, |_, _| false)
}

/// As [`combine`], but obstacles that `adjoin` (by their ids, either way round) are not combined for being near each other:
/// pieces of one long wall, whose hull would close the corridor along it (9.2, Fig. 9.1). They still are when something
/// else joins them.
///
/// # Errors
/// As [`combine`].
pub fn combine_unless(
    obstacles: &[Obstacle],
    clearance: f64,
    adjoin: impl Fn(u32, u32) -> bool,
) -> Result<Vec<ApparentObstacle>, HullError> {
    let clearance = length("the clearance", clearance)?;
    let mut sorted: Vec<&Obstacle> = obstacles.iter().collect();
    sorted.sort_by_key(|obstacle| obstacle.id);
    if let Some(pair) = sorted.windows(2).find(|pair| pair[0].id == pair[1].id) {
        return Err(HullError::DuplicateId(pair[0].id));
    }
    let single = |(index, obstacle): (usize, &&Obstacle)| Group::new(vec![index], obstacle.shape.clone());
    let mut groups: Vec<Group> = sorted.iter().enumerate().map(single).collect();
    while merge_once(&mut groups, &sorted, clearance, &adjoin) {}
    groups.sort_by_key(|group| group.members[0]);
    let named = |group: Group| {
        let members: Vec<u32> = group.members.iter().map(|index| sorted[*index].id).collect();
        ApparentObstacle { id: members[0], members, shape: group.shape }
    };
    Ok(groups.into_iter().map(named).collect())
}

/// Box of a group: apart from the groups, so that the sweep over all pairs reads little memory.
struct Slot {
    low: [f64; 2],
    high: [f64; 2],
    fresh: bool,
}

/// Joins all groups that are near each other now; whether there were any.
fn merge_once(
    groups: &mut Vec<Group>,
    obstacles: &[&Obstacle],
    clearance: f64,
    adjoin: &impl Fn(u32, u32) -> bool,
) -> bool {
    groups.sort_unstable_by(|a, b| a.low[0].total_cmp(&b.low[0]).then(a.members[0].cmp(&b.members[0])));
    let mut parents: Vec<usize> = (0..groups.len()).collect();
    let slots: Vec<Slot> =
        groups.iter().map(|group| Slot { low: group.low, high: group.high, fresh: group.fresh }).collect();
    let mut merged = false;
    for (i, slot) in slots.iter().enumerate() {
        for (other, j) in slots[i + 1..].iter().zip(i + 1..) {
            if other.low[0] - slot.high[0] >= clearance {
                break;
            }
            let apart = (slot.low[1] - other.high[1]).max(other.low[1] - slot.high[1]);
            if apart >= clearance || !(slot.fresh || other.fresh) {
                continue;
            }
            let (first, second) = (root(&mut parents, i), root(&mut parents, j));
            if first != second
                && groups[i].is_nearer_than(&groups[j], clearance)
                && !only_adjoin(&groups[i], &groups[j], obstacles, clearance, adjoin)
            {
                parents[first.max(second)] = first.min(second);
                merged = true;
            }
        }
    }
    if merged {
        join(groups, &mut parents, obstacles);
    }
    merged
}

/// Whether two groups are near each other by members that adjoin, and by no others.
fn only_adjoin(
    a: &Group,
    b: &Group,
    obstacles: &[&Obstacle],
    clearance: f64,
    adjoin: &impl Fn(u32, u32) -> bool,
) -> bool {
    let pairs = a.members.iter().flat_map(|i| b.members.iter().map(|j| (obstacles[*i], obstacles[*j])));
    let mut any = false;
    for (one, other) in pairs {
        if adjoin(one.id, other.id) || adjoin(other.id, one.id) {
            any = true;
        } else if one.shape.outline().is_nearer_than(&other.shape.outline(), clearance) {
            return false;
        }
    }
    any
}

/// Replaces the groups of each root by their union.
fn join(groups: &mut Vec<Group>, parents: &mut [usize], obstacles: &[&Obstacle]) {
    let mut unions: Vec<Vec<Group>> = Vec::new();
    unions.resize_with(groups.len(), Vec::new);
    for (index, group) in core::mem::take(groups).into_iter().enumerate() {
        unions[root(parents, index)].push(group);
    }
    for mut parts in unions {
        match parts.len() {
            0 => {}
            1 => groups.extend(parts.pop().map(|group| Group { fresh: false, ..group })),
            _ => groups.push(Group::union(&parts, obstacles)),
        }
    }
}

/// Root of a node, halving the path to it.
fn root(parents: &mut [usize], mut node: usize) -> usize {
    while parents[node] != node {
        parents[node] = parents[parents[node]];
        node = parents[node];
    }
    node
}

impl Group {
    fn new(members: Vec<usize>, shape: Shape) -> Self {
        let outline = shape.outline();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in outline.points {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis] - outline.radius);
                high[axis] = high[axis].max(point[axis] + outline.radius);
            }
        }
        Self { members, low, high, shape, fresh: true }
    }

    /// The hull of hulls, which is that of their members if all are rounded off alike (then far fewer corners count).
    fn union(parts: &[Self], obstacles: &[&Obstacle]) -> Self {
        let mut members: Vec<usize> = parts.iter().flat_map(|part| part.members.iter().copied()).collect();
        members.sort_unstable();
        let radius = obstacles[members[0]].shape.outline().radius;
        let alike = members.iter().all(|member| obstacles[*member].shape.outline().radius == radius);
        let shape = if alike {
            Shape::around(parts.iter().map(|part| &part.shape))
        } else {
            Shape::around(members.iter().map(|member| &obstacles[*member].shape))
        };
        Self::new(members, shape)
    }

    fn is_nearer_than(&self, other: &Self, clearance: f64) -> bool {
        self.shape.outline().is_nearer_than(&other.shape.outline(), clearance)
    }
}
