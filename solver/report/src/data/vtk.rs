//! Legacy VTK, a rectilinear grid as ParaView opens it (VTK file formats, version 3.0).

use super::{Dataset, Fact};
use landau_solver::file::seal::BLANK;
use std::fmt::Write;

/// The last axis is x, the one before it y. What is over y alone, and what the numbers were computed from, is field data.
pub(super) fn encode(data: &Dataset) -> Result<Vec<u8>, String> {
    let [y, x] = data.axes.as_slice() else {
        return Err(format!("VTK takes two axes, not {}", data.axes.len()));
    };
    let title = data.attributes.iter().find_map(|(_, value)| match value {
        Fact::Text(text) => Some(deunicode::deunicode(text)),
        Fact::Number(_) => None,
    });
    // The title is one line of at most 256 bytes; the seal stands at its end.
    let mut text = format!(
        "# vtk DataFile Version 3.0\n{:.200} {BLANK}\nASCII\nDATASET RECTILINEAR_GRID\n",
        crate::shown(&title.unwrap_or_default()),
    );
    let profiles: Vec<_> = data
        .arrays
        .iter()
        .filter(|array| array.axes.len() == 1)
        .collect();
    let numbers: Vec<(&String, f64)> = data
        .attributes
        .iter()
        .filter_map(|(name, value)| match value {
            Fact::Number(number) => Some((name, *number)),
            Fact::Text(_) => None,
        })
        .collect();
    text += &format!("FIELD FieldData {}\n", numbers.len() + profiles.len());
    for (name, number) in numbers {
        text += &format!("{name} 1 1 double\n{number:e}\n");
    }
    for profile in profiles {
        text += &format!("{} 1 {} double\n", profile.name, profile.values.len());
        list(&mut text, &profile.values);
    }
    text += &format!("DIMENSIONS {} {} 1\n", x.values.len(), y.values.len());
    for (name, values) in [("X", x.values.as_slice()), ("Y", &y.values), ("Z", &[0.0])] {
        text += &format!("{name}_COORDINATES {} double\n", values.len());
        list(&mut text, values);
    }
    text += &format!("POINT_DATA {}\n", x.values.len() * y.values.len());
    for array in data.arrays.iter().filter(|array| array.axes.len() == 2) {
        text += &format!("SCALARS {} double 1\nLOOKUP_TABLE default\n", array.name);
        list(&mut text, &array.values);
    }
    for (name, components) in &data.vectors {
        let values = |component: &String| {
            let found = data.arrays.iter().find(|array| array.name == *component);
            found
                .map(|array| &array.values)
                .ok_or_else(|| format!("there is no array {component}"))
        };
        let [u, v] = [values(&components[0])?, values(&components[1])?];
        text += &format!("VECTORS {name} double\n");
        for (u, v) in u.iter().zip(v) {
            text += &format!("{u:e} {v:e} 0\n");
        }
    }
    Ok(text.into_bytes())
}

fn list(text: &mut String, values: &[f64]) {
    for line in values.chunks(8) {
        let numbers: Vec<String> = line.iter().map(|v| format!("{v:e}")).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}", numbers.join(" "));
    }
}
