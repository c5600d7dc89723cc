//! Combined apparent obstacles (7.7), (7.8): everything nearer to each other than the clearance becomes one hull.
//!
//! Separations are those between hulls, and combining is repeated until no two hulls are nearer than the clearance: a
//! combined hull may come near to what neither member is near to. The fixpoint is unique, as hulls only grow, so the
//! result depends on the set of obstacles alone.
use super::{HullError, Shape, shape::length};
use std::collections::BTreeMap;

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
    members: Vec<u32>,
    shape: Shape,
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
    let single = |(index, obstacle): (u32, &&Obstacle)| Group { members: vec![index], shape: obstacle.shape.clone() };
    let mut groups: Vec<Group> = (0..).zip(&sorted).map(single).collect();
    let mut slots: Vec<Slot> = (0..).zip(&groups).map(|(index, group)| Slot::of(index, group)).collect();
    sort(&mut slots);
    while merge_once(&mut groups, &mut slots, &sorted, clearance, &adjoin) {}
    let mut lives = vec![false; groups.len()];
    slots.iter().for_each(|slot| lives[slot.group] = true);
    let named = |group: Group| {
        let members: Vec<u32> = group.members.into_iter().map(|index| sorted[index as usize].id).collect();
        ApparentObstacle { id: members[0], members, shape: group.shape }
    };
    let living = groups.into_iter().zip(lives).filter(|(_, lives)| *lives);
    let mut combined: Vec<ApparentObstacle> = living.map(|(group, _)| named(group)).collect();
    combined.sort_unstable_by_key(|obstacle| obstacle.id);
    Ok(combined)
}

/// Box of a group that is not part of another: apart from the groups, so that the sweep over all pairs reads little memory.
struct Slot {
    low: [f64; 2],
    high: [f64; 2],
    /// Whether the group was formed in the last round: only then can it have new neighbours.
    fresh: bool,
    group: usize,
}

/// From left to right.
fn sort(slots: &mut [Slot]) {
    slots.sort_by(|a, b| a.low[0].total_cmp(&b.low[0]).then(a.group.cmp(&b.group)));
}

/// Joins all groups that are near each other now; whether there were any.
fn merge_once(
    groups: &mut Vec<Group>,
    slots: &mut Vec<Slot>,
    obstacles: &[&Obstacle],
    clearance: f64,
    adjoin: &impl Fn(u32, u32) -> bool,
) -> bool {
    let widest = slots.iter().map(|slot| slot.high[0] - slot.low[0]).fold(0.0, f64::max);
    let mut parents: Vec<usize> = (0..groups.len()).collect();
    let mut merged = false;
    let mut meet = |a: &Slot, b: &Slot| {
        let apart = (a.low[1] - b.high[1]).max(b.low[1] - a.high[1]);
        if apart >= clearance || (a.low[0] - b.high[0]).max(b.low[0] - a.high[0]) >= clearance {
            return;
        }
        let (first, second) = (root(&mut parents, a.group), root(&mut parents, b.group));
        let (one, other) = (&groups[a.group], &groups[b.group]);
        if first != second
            && one.is_nearer_than(other, clearance)
            && !only_adjoin(one, other, obstacles, clearance, adjoin)
        {
            parents[first.max(second)] = first.min(second);
            merged = true;
        }
    };
    for (i, slot) in slots.iter().enumerate().filter(|(_, slot)| slot.fresh) {
        for other in slots[i + 1..].iter().take_while(|other| other.low[0] - slot.high[0] < clearance) {
            meet(slot, other);
        }
        // Those that are fresh have looked ahead themselves.
        let before = slots[..i].iter().rev().take_while(|other| slot.low[0] - other.low[0] - widest < clearance);
        for other in before.filter(|other| !other.fresh) {
            meet(slot, other);
        }
    }
    if merged {
        join(groups, slots, &mut parents, obstacles);
    }
    merged
}

/// Puts unions in the places of the groups of each root.
fn join(groups: &mut Vec<Group>, slots: &mut Vec<Slot>, parents: &mut [usize], obstacles: &[&Obstacle]) {
    let mut unions: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for slot in slots.iter_mut() {
        slot.fresh = false;
        let root = root(parents, slot.group);
        if root != slot.group {
            unions.entry(root).or_insert_with(|| vec![root]).push(slot.group);
        }
    }
    slots.retain(|slot| parents[slot.group] == slot.group && !unions.contains_key(&slot.group));
    for parts in unions.into_values() {
        let union = Group::union(&parts.iter().map(|part| &groups[*part]).collect::<Vec<_>>(), obstacles);
        slots.push(Slot::of(groups.len(), &union));
        groups.push(union);
    }
    sort(slots);
}

/// Whether two groups are near each other by members that adjoin, and by no others.
fn only_adjoin(
    a: &Group,
    b: &Group,
    obstacles: &[&Obstacle],
    clearance: f64,
    adjoin: &impl Fn(u32, u32) -> bool,
) -> bool {
    let pairs =
        a.members.iter().flat_map(|i| b.members.iter().map(|j| (obstacles[*i as usize], obstacles[*j as usize])));
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

/// Root of a node, halving the path to it.
fn root(parents: &mut [usize], mut node: usize) -> usize {
    while parents[node] != node {
        parents[node] = parents[parents[node]];
        node = parents[node];
    }
    node
}

impl Slot {
    fn of(group: usize, Group { shape, .. }: &Group) -> Self {
        let outline = shape.outline();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in outline.points {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis] - outline.radius);
                high[axis] = high[axis].max(point[axis] + outline.radius);
            }
        }
        Self { low, high, fresh: true, group }
    }
}

impl Group {
    /// The hull of hulls, which is that of their members if all are rounded off alike (then far fewer corners count).
    fn union(parts: &[&Self], obstacles: &[&Obstacle]) -> Self {
        let mut members: Vec<u32> = parts.iter().flat_map(|part| part.members.iter().copied()).collect();
        members.sort_unstable();
        let radius = obstacles[members[0] as usize].shape.outline().radius;
        let alike = members.iter().all(|member| obstacles[*member as usize].shape.outline().radius == radius);
        let shape = if alike {
            Shape::around(parts.iter().map(|part| &part.shape))
        } else {
            Shape::around(members.iter().map(|member| &obstacles[*member as usize].shape))
        };
        Self { members, shape }
    }

    fn is_nearer_than(&self, other: &Self, clearance: f64) -> bool {
        self.shape.outline().is_nearer_than(&other.shape.outline(), clearance)
    }
}
