//! MathML as a page may have it: elements and attributes from a list, everything else refused.
//!
//! The renderer of LaTeX copies some words of a formula as they are, `\operatorname{…}` among them, so that a formula
//! could bring elements of its own.

/// Elements of MathML Core that formulas are made of.
const ELEMENTS: [&str; 25] = [
    "math",
    "mi",
    "mn",
    "mo",
    "ms",
    "mtext",
    "mspace",
    "mrow",
    "mfrac",
    "msqrt",
    "mroot",
    "mstyle",
    "mpadded",
    "mphantom",
    "menclose",
    "msub",
    "msup",
    "msubsup",
    "munder",
    "mover",
    "munderover",
    "mmultiscripts",
    "mtable",
    "mtr",
    "mtd",
];

/// Attributes, each with values of words, numbers and units.
const ATTRIBUTES: [&str; 24] = [
    "class",
    "style",
    "display",
    "displaystyle",
    "scriptlevel",
    "mathvariant",
    "stretchy",
    "symmetric",
    "fence",
    "separator",
    "form",
    "lspace",
    "rspace",
    "minsize",
    "maxsize",
    "largeop",
    "movablelimits",
    "accent",
    "accentunder",
    "linethickness",
    "width",
    "height",
    "depth",
    "notation",
];

/// The one attribute with an address: the namespace.
const NAMESPACE: &str = "xmlns=\"http://www.w3.org/1998/Math/MathML\"";

/// Names of characters that the renderer writes.
const CHARACTERS: [&str; 4] = ["amp;", "lt;", "gt;", "nbsp;"];

/// Whether a text is MathML and nothing else, every element closed in its turn.
pub(super) fn is_mathml(text: &str) -> bool {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find('<') {
        let (before, tag) = rest.split_at(at);
        let Some((inside, after)) = tag[1..].split_once('>') else {
            return false;
        };
        if !is_text(before) {
            return false;
        }
        rest = after;
        if let Some(name) = inside.strip_prefix('/') {
            if open.pop() != Some(name) {
                return false;
            }
            continue;
        }
        let (inside, closed) = match inside.strip_suffix('/') {
            Some(inside) => (inside, true),
            None => (inside, false),
        };
        let Some(name) = element(inside) else {
            return false;
        };
        if !closed {
            open.push(name);
        }
    }
    is_text(rest) && open.is_empty()
}

/// The name of an opening tag whose attributes are all on the list.
fn element(inside: &str) -> Option<&str> {
    let (name, mut rest) = inside.split_once(' ').unwrap_or((inside, ""));
    if !ELEMENTS.contains(&name) {
        return None;
    }
    loop {
        rest = rest.trim_start();
        if rest.is_empty() {
            return Some(name);
        }
        if let Some(after) = rest.strip_prefix(NAMESPACE) {
            rest = after;
            continue;
        }
        let (attribute, after) = rest.split_once("=\"")?;
        let (value, after) = after.split_once('"')?;
        if !ATTRIBUTES.contains(&attribute) || !is_value(attribute, value) {
            return None;
        }
        rest = after;
    }
}

/// Whether a value of an attribute has words, numbers and units alone; a style has colours and lengths.
fn is_value(attribute: &str, value: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, ' ' | '-' | '.' | '%' | '+');
    if attribute != "style" {
        return value.chars().all(plain);
    }
    value.split(';').all(|rule| {
        let Some((name, value)) = rule.split_once(':') else {
            return rule.trim().is_empty();
        };
        let known = [
            "color",
            "background-color",
            "border",
            "border-color",
            "margin-left",
            "height",
        ];
        let colour = value.replace("rgb(", " ").replace(')', " ");
        let kept = |c: char| plain(c) || c == '#';
        known.contains(&name.trim()) && colour.chars().all(kept)
    })
}

/// Whether what stands between elements is text: no sign of another element, characters by their names.
fn is_text(text: &str) -> bool {
    let named = text.split('&').skip(1).all(|after| {
        let number = after.strip_prefix('#').and_then(|a| a.split_once(';'));
        let number = number.is_some_and(|(digits, _)| {
            !digits.is_empty() && digits.chars().all(|c| c.is_ascii_alphanumeric())
        });
        number || CHARACTERS.iter().any(|name| after.starts_with(name))
    });
    named && !text.contains('>')
}

#[cfg(test)]
mod tests {
    use super::is_mathml;

    #[test]
    fn elements_from_a_list() {
        for good in [
            "<math><mi>x</mi></math>",
            "<math xmlns=\"http://www.w3.org/1998/Math/MathML\" display=\"block\"><mo stretchy=\"true\">&lt;</mo></math>",
            "<mi style=\"color: rgb(255 0 255); border: 0.06em solid rgb(1 2 3)\">x</mi>",
            "<mspace width=\"-0.2em\" style=\"margin-left: -0.2em\" />",
        ] {
            assert!(is_mathml(good), "{good}");
        }
        for bad in [
            "<math><mi><img src=x onerror=alert(1)></mi></math>",
            "<math><mi onclick=\"x\">x</mi></math>",
            "<math><mi href=\"javascript:x\">x</mi></math>",
            "<math><script>x</script></math>",
            "<math><mtext></math><p></p><math></mtext></math>",
            "<mi style=\"background: url(x)\">x</mi>",
            "<mi class=\"a\" b>x</mi>",
            "<math><mi>a < b</mi></math>",
            "<math><mi>&Tab;&unknown;</mi></math>",
            "<math><mi>x</mi>",
            "<annotation-xml>x</annotation-xml>",
            "<mi\u{0}>x</mi>",
            "<!--x-->",
        ] {
            assert!(!is_mathml(bad), "{bad}");
        }
    }
}
