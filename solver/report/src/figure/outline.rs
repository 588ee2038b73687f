//! Shading as outlines: the plotting library fills a level cell by cell, which leaves seams and a large file.

use kuva::render::render::{PathData, Primitive, Scene};
use std::collections::{BTreeMap, VecDeque};

/// Parts of a pixel that two corners may differ by and be one.
const PARTS: f64 = 50.0;

type Corner = (i64, i64);

/// Parts of a pixel by which a line may be straightened.
const TOLERANCE: f64 = 0.2 * PARTS;

/// The same scene with abutting polygons merged, pieces of a line joined, and what is drawn alike one after another
/// drawn at once.
pub(super) fn outlined(mut scene: Scene) -> Scene {
    scene.elements = gathered(std::mem::take(&mut scene.elements));
    for element in &mut scene.elements {
        let Primitive::Path(path) = element else {
            continue;
        };
        let Some(pieces) = pieces(&path.d) else {
            continue;
        };
        let lines = match path.fill {
            Some(_) if pieces.iter().all(|p| p.closed) => outlines(&pieces),
            None => joined(pieces),
            _ => continue,
        };
        path.d = lines.iter().map(text).collect();
    }
    scene
}

/// Lines and paths of one style, drawn between other things, as one path: arrows are two styles in turn.
fn gathered(elements: Vec<Primitive>) -> Vec<Primitive> {
    let mut gathered: Vec<Primitive> = Vec::new();
    let mut known: BTreeMap<String, usize> = BTreeMap::new();
    for element in elements {
        let path = match element {
            Primitive::Line {
                x1,
                y1,
                x2,
                y2,
                stroke,
                stroke_width,
                stroke_dasharray: None,
            } => PathData {
                d: format!("M{x1:.2} {y1:.2} L{x2:.2} {y2:.2} "),
                fill: None,
                stroke,
                stroke_width,
                opacity: None,
                stroke_dasharray: None,
            },
            Primitive::Path(path) => *path,
            other => {
                known.clear();
                gathered.push(other);
                continue;
            }
        };
        let PathData {
            fill,
            stroke,
            stroke_width,
            opacity,
            stroke_dasharray,
            ..
        } = &path;
        let style = format!("{fill:?} {stroke:?} {stroke_width} {opacity:?} {stroke_dasharray:?}");
        let like = known.get(&style).and_then(|&i| gathered.get_mut(i));
        match like {
            Some(Primitive::Path(like)) => like.d += &path.d,
            _ => {
                known.insert(style, gathered.len());
                gathered.push(Primitive::Path(Box::new(path)));
            }
        }
    }
    gathered
}

/// A line of corners.
struct Line {
    corners: Vec<Corner>,
    closed: bool,
}

/// The pieces of a path of straight lines; nothing where there is a curve in it.
fn pieces(path: &str) -> Option<Vec<Line>> {
    let mut pieces: Vec<Line> = Vec::new();
    let mut rest = path.trim_start();
    while let Some(command) = rest.chars().next() {
        rest = &rest[1..];
        match command {
            'M' | 'L' => {
                let x = number(&mut rest)?;
                let corner = (x, number(&mut rest)?);
                if command == 'M' {
                    let (corners, closed) = (Vec::new(), false);
                    pieces.push(Line { corners, closed });
                }
                pieces.last_mut()?.corners.push(corner);
            }
            'Z' => pieces.last_mut()?.closed = true,
            _ => return None,
        }
        rest = rest.trim_start();
    }
    Some(pieces)
}

/// The next number, in parts of a pixel.
fn number(rest: &mut &str) -> Option<i64> {
    let text = rest.trim_start_matches([' ', ',']);
    let inside = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    let (number, after) = text.split_at(text.find(|c| !inside(c)).unwrap_or(text.len()));
    *rest = after;
    let value: f64 = number.parse().ok()?;
    Some((value * PARTS).round() as i64)
}

/// The outlines of polygons that abut: an edge that two of them have, once in each direction, is inside.
fn outlines(polygons: &[Line]) -> Vec<Line> {
    let mut edges: BTreeMap<Corner, Vec<Corner>> = BTreeMap::new();
    for polygon in polygons {
        let mut corners = polygon.corners.clone();
        corners.dedup();
        // All the same way round, whichever way they were drawn.
        if area(&corners) < 0 {
            corners.reverse();
        }
        for (index, &from) in corners.iter().enumerate() {
            let to = corners[(index + 1) % corners.len()];
            if from == to {
                continue;
            }
            let back = edges.get_mut(&to).and_then(|ends| {
                let position = ends.iter().position(|end| *end == from)?;
                Some(ends.swap_remove(position))
            });
            if back.is_none() {
                edges.entry(from).or_default().push(to);
            }
        }
    }
    let mut lines = Vec::new();
    edges.retain(|_, ends| !ends.is_empty());
    while let Some((&start, _)) = edges.first_key_value() {
        let mut corners = vec![start];
        let mut at = start;
        while let Some(ends) = edges.get_mut(&at) {
            let next = ends.pop();
            if ends.is_empty() {
                edges.remove(&at);
            }
            match next {
                Some(next) if next != start => corners.push(next),
                _ => break,
            }
            at = corners[corners.len() - 1];
        }
        let closed = true;
        lines.push(Line {
            corners: straightened_loop(corners),
            closed,
        });
    }
    lines
}

/// Twice the area, by its sign the way round.
fn area(corners: &[Corner]) -> i64 {
    let next = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(next)
        .map(|(a, b)| a.0 * b.1 - b.0 * a.1)
        .sum()
}

/// Corners without those from which the line hardly departs (Douglas & Peucker 1973).
fn straightened(corners: &[Corner]) -> Vec<Corner> {
    let [first, inner @ .., last] = corners else {
        return corners.to_vec();
    };
    let (dx, dy) = ((last.0 - first.0) as f64, (last.1 - first.1) as f64);
    let length = dx.hypot(dy);
    let distance = |corner: &Corner| {
        let (x, y) = ((corner.0 - first.0) as f64, (corner.1 - first.1) as f64);
        match length > 0.0 {
            true => (dx * y - dy * x).abs() / length,
            false => x.hypot(y),
        }
    };
    let farthest = inner.iter().enumerate().map(|(i, c)| (i + 1, distance(c)));
    match farthest.max_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((at, far)) if far > TOLERANCE => {
            let mut kept = straightened(&corners[..=at]);
            kept.pop();
            kept.extend(straightened(&corners[at..]));
            kept
        }
        Some(_) => vec![*first, *last],
        None => corners.to_vec(),
    }
}

/// A closed line, straightened from its first corner to the one farthest from it and back.
fn straightened_loop(mut corners: Vec<Corner>) -> Vec<Corner> {
    corners.extend(corners.first().copied());
    let mut kept = straightened(&corners);
    kept.pop();
    kept
}

/// Lines that meet at their ends, as one.
fn joined(pieces: Vec<Line>) -> Vec<Line> {
    let mut ends: BTreeMap<Corner, Vec<usize>> = BTreeMap::new();
    let mut open: Vec<Option<Vec<Corner>>> = Vec::new();
    let mut lines: Vec<Line> = Vec::new();
    for piece in pieces {
        if piece.closed || piece.corners.len() < 2 {
            lines.push(piece);
            continue;
        }
        for end in [piece.corners[0], piece.corners[piece.corners.len() - 1]] {
            ends.entry(end).or_default().push(open.len());
        }
        open.push(Some(piece.corners));
    }
    for index in 0..open.len() {
        let Some(first) = open[index].take() else {
            continue;
        };
        let mut line = VecDeque::from(first);
        let mut meets = |at: Corner| {
            let others = ends.get(&at)?;
            let next = others.iter().find_map(|&i| open[i].take())?;
            Some(match next[0] == at {
                true => next,
                false => next.into_iter().rev().collect(),
            })
        };
        while let Some(next) = line.back().copied().and_then(&mut meets) {
            line.extend(next.into_iter().skip(1));
        }
        while let Some(next) = line.front().copied().and_then(&mut meets) {
            next.into_iter()
                .skip(1)
                .for_each(|corner| line.push_front(corner));
        }
        let (corners, closed) = (straightened(&Vec::from(line)), false);
        lines.push(Line { corners, closed });
    }
    lines
}

fn text(line: &Line) -> String {
    let shown = |value: i64| {
        let value = (value as f64 / PARTS * 10.0).round() / 10.0;
        value.to_string()
    };
    let mut text = String::new();
    for (index, (x, y)) in line.corners.iter().enumerate() {
        let command = if index == 0 { 'M' } else { 'L' };
        text += &format!("{command}{} {}", shown(*x), shown(*y));
    }
    if line.closed {
        text.push('Z');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{joined, outlines, pieces, text};

    fn merged(path: &str) -> Vec<String> {
        outlines(&pieces(path).expect("straight"))
            .iter()
            .map(text)
            .collect()
    }

    #[test]
    fn abutting_polygons_become_one() {
        // Two squares beside one another, the second the other way round.
        let found = merged("M0 0 L1 0 L1 1 L0 1 Z M1 1 L2 1 L2 0 L1 0 Z");
        assert_eq!(found, ["M0 0L2 0L2 1L0 1Z"]);
        // Eight squares around a hole.
        let mut ring = String::new();
        for (x, y) in [
            (0, 0),
            (1, 0),
            (2, 0),
            (0, 1),
            (2, 1),
            (0, 2),
            (1, 2),
            (2, 2),
        ] {
            ring += &format!("M{x} {y} L{0} {y} L{0} {1} L{x} {1} Z", x + 1, y + 1);
        }
        assert_eq!(merged(&ring).len(), 2);
        assert!(pieces("M0 0 C1 1 2 2 3 3").is_none());
    }

    #[test]
    fn pieces_that_meet_become_one_line() {
        let found = joined(pieces("M2 0 L1 1 M0 0 L1 1 M5 5 L6 7").expect("straight"));
        let texts: Vec<String> = found.iter().map(text).collect();
        assert_eq!(texts, ["M2 0L1 1L0 0", "M5 5L6 7"]);
    }
}
