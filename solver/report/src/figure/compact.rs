//! Smaller SVG: the shading comes as one polygon a cell and level, and most are abutting rectangles.

/// The same picture with coordinates of paths to a tenth of a pixel and rectangles merged.
pub(super) fn paths(svg: &str) -> String {
    let mut short = String::with_capacity(svg.len() / 8);
    let mut rest = svg;
    while let Some(start) = rest.find(" d=\"") {
        let (before, path) = rest.split_at(start + 4);
        let end = path.find('"').unwrap_or(path.len());
        short.push_str(before);
        short.push_str(&merged(&rounded(&path[..end])));
        rest = &path[end..];
    }
    short.push_str(rest);
    short
}

fn rounded(path: &str) -> String {
    let mut short = String::with_capacity(path.len() / 2);
    let separates = |c: char| !c.is_ascii_digit() && c != '.';
    for part in path.split_inclusive(separates) {
        let digits = part.find(separates).unwrap_or(part.len());
        let (number, separator) = part.split_at(digits);
        let point = number.find('.').unwrap_or(number.len());
        short.push_str(&number[..number.len().min(point + 2)]);
        short.push_str(separator);
    }
    short
}

/// Left, right, and the two heights as they are written.
struct Rectangle<'p> {
    left: &'p str,
    right: &'p str,
    heights: [&'p str; 2],
}

impl Rectangle<'_> {
    fn text(&self) -> String {
        let ([first, second], left, right) = (self.heights, self.left, self.right);
        format!("M{left} {first}H{right}V{second}H{left}Z")
    }
}

/// Neighbours in a row of rectangles become one.
fn merged(path: &str) -> String {
    let mut text = String::with_capacity(path.len());
    let mut open: Option<Rectangle> = None;
    for piece in path.split_inclusive('Z') {
        let next = rectangle(piece.trim());
        match (&mut open, next) {
            (Some(run), Some(next)) if run.right == next.left && run.heights == next.heights => {
                run.right = next.right;
            }
            (_, next) => {
                text.extend(open.take().map(|run| run.text()));
                if next.is_none() {
                    text.push_str(piece);
                }
                open = next;
            }
        }
    }
    text.extend(open.map(|run| run.text()));
    text
}

/// `Mx0 y0 Lx1 y0 Lx1 y1 Lx0 y1 Z`
fn rectangle(piece: &str) -> Option<Rectangle<'_>> {
    let body = piece.strip_prefix('M')?.strip_suffix('Z')?;
    let mut corners = body.split('L').map(|corner| corner.trim().split_once(' '));
    let [a, b, c, d] = [
        corners.next()??,
        corners.next()??,
        corners.next()??,
        corners.next()??,
    ];
    let closes = corners.next().is_none();
    let upright = a.1 == b.1 && b.0 == c.0 && c.1 == d.1 && d.0 == a.0;
    (closes && upright).then_some(Rectangle {
        left: a.0,
        right: b.0,
        heights: [a.1, c.1],
    })
}
