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
    let bands = Bands::of(&slots, clearance);
    bands.sort(&mut slots);
    while merge_once(&mut groups, &mut slots, &bands, &sorted, clearance, &adjoin) {}
    let mut lives = vec![false; groups.len()];
    slots.iter().for_each(|slot| lives[slot.group] = true);
    let named = |group: Group| {
        let members: Vec<u32> = group.members.into_iter().map(|index| sorted[index as usize].id).collect();
        ApparentObstacle { id: members[0], members, shape: group.shape }
    };
    let living = groups.into_iter().zip(lives).filter(|(_, lives)| *lives);
    let mut combined: Vec<ApparentObstacle> = living.map(|(group, _)| named(group)).collect();
    // Those that stayed alone are in order already, which a stable sort makes use of.
    combined.sort_by_key(|obstacle| obstacle.id);
    Ok(combined)
}

/// Box of a group that is not part of another: apart from the groups, so that the sweep over all pairs reads little memory.
struct Slot {
    low: [f64; 2],
    high: [f64; 2],
    band: usize,
    /// Whether the group was formed in the last round: only then can it have new neighbours.
    fresh: bool,
    group: usize,
}

/// Horizontal bands: a slot is in that of its lower side.
struct Bands {
    origin: f64,
    /// m.
    height: f64,
    count: usize,
}

impl Bands {
    /// As high as the highest slot with the clearance, but no more of them than there are slots.
    fn of(slots: &[Slot], clearance: f64) -> Self {
        let lows = slots.iter().map(|slot| slot.low[1]);
        let (origin, last) =
            lows.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), low| (least.min(low), most.max(low)));
        let highest = slots.iter().map(|slot| slot.high[1] - slot.low[1]).fold(0.0, f64::max);
        let count = slots.len().max(1);
        let height = (highest + clearance).max((last - origin) / count as f64).max(f64::MIN_POSITIVE);
        Self { origin, height, count }
    }

    fn at(&self, y: f64) -> usize {
        (((y - self.origin) / self.height).max(0.0) as usize).min(self.count - 1)
    }

    /// From left to right in each band.
    fn sort(&self, slots: &mut [Slot]) {
        slots.iter_mut().for_each(|slot| slot.band = self.at(slot.low[1]));
        slots.sort_by(|a, b| a.band.cmp(&b.band).then(a.low[0].total_cmp(&b.low[0])).then(a.group.cmp(&b.group)));
    }

    /// Where each band begins among sorted slots, and where the last one ends.
    fn starts(&self, slots: &[Slot]) -> Vec<usize> {
        let mut starts = vec![0; self.count + 1];
        for slot in slots {
            starts[slot.band + 1] += 1;
        }
        for band in 0..self.count {
            starts[band + 1] += starts[band];
        }
        starts
    }
}

/// Joins all groups that are near each other now; whether there were any.
fn merge_once(
    groups: &mut Vec<Group>,
    slots: &mut Vec<Slot>,
    bands: &Bands,
    obstacles: &[&Obstacle],
    clearance: f64,
    adjoin: &impl Fn(u32, u32) -> bool,
) -> bool {
    let starts = bands.starts(slots);
    let widest = slots.iter().map(|slot| slot.high[0] - slot.low[0]).fold(0.0, f64::max);
    let mut parents: Vec<usize> = (0..groups.len()).collect();
    let mut merged = false;
    let mut meet = |a: &Slot, b: &Slot| {
        let apart = |axis: usize| (a.low[axis] - b.high[axis]).max(b.low[axis] - a.high[axis]);
        if !(a.fresh || b.fresh) || apart(1) >= clearance || apart(0) >= clearance {
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
    // By bands above that of a slot: what is to the left of all that it can meet. It only goes on to the right within a band.
    let (mut firsts, mut from) = (Vec::new(), usize::MAX);
    for (i, slot) in slots.iter().enumerate() {
        let reached = |other: &&Slot| other.low[0] - slot.high[0] < clearance;
        slots[i + 1..starts[slot.band + 1]].iter().take_while(reached).for_each(|other| meet(slot, other));
        if from != slot.band {
            firsts.clear();
            from = slot.band;
        }
        // What is in a lower band has looked up here itself.
        for (above, band) in (slot.band + 1..=bands.at(slot.high[1] + clearance)).enumerate() {
            if firsts.len() == above {
                firsts.push(starts[band]);
            }
            let (first, end) = (&mut firsts[above], starts[band + 1]);
            while *first < end && slot.low[0] - slots[*first].low[0] - widest >= clearance {
                *first += 1;
            }
            slots[*first..end].iter().take_while(reached).for_each(|other| meet(slot, other));
        }
    }
    if merged {
        join(groups, slots, &mut parents, obstacles);
        bands.sort(slots);
    }
    merged
}

/// Puts unions in the places of the groups of each root.
fn join(groups: &mut Vec<Group>, slots: &mut Vec<Slot>, parents: &mut [usize], obstacles: &[&Obstacle]) {
    // Of those that grow: which union they are, and its parts.
    let mut grows: Vec<Option<usize>> = vec![None; groups.len()];
    let mut unions: Vec<Vec<usize>> = Vec::new();
    for slot in slots.iter_mut() {
        slot.fresh = false;
        let root = root(parents, slot.group);
        if root != slot.group {
            let union = *grows[root].get_or_insert_with(|| {
                unions.push(vec![root]);
                unions.len() - 1
            });
            unions[union].push(slot.group);
        }
    }
    slots.retain(|slot| parents[slot.group] == slot.group && grows[slot.group].is_none());
    for parts in unions {
        let union = Group::union(&parts.iter().map(|part| &groups[*part]).collect::<Vec<_>>(), obstacles);
        slots.push(Slot::of(groups.len(), &union));
        groups.push(union);
    }
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
        Self { low, high, band: 0, fresh: true, group }
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
