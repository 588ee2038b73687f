//! Legacy VTK, a rectilinear grid as ParaView opens it (VTK file formats, version 3.0).

use super::Dataset;
use std::fmt::Write;

/// The last axis is x, the one before it y.
pub(super) fn encode(data: &Dataset) -> Result<Vec<u8>, String> {
    let [(_, y), (_, x)] = data.axes.as_slice() else {
        return Err(format!("VTK takes two axes, not {}", data.axes.len()));
    };
    let title = data.attributes.first().map_or("", |(_, value)| value);
    // The title is one line of at most 256 bytes.
    let title: String = title
        .chars()
        .filter(|c| c.is_ascii_graphic() || *c == ' ')
        .collect();
    let mut text = format!(
        "# vtk DataFile Version 3.0\n{:.200}\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS {} {} 1\n",
        title,
        x.len(),
        y.len()
    );
    for (name, values) in [("X", x.as_slice()), ("Y", y), ("Z", &[0.0])] {
        text += &format!("{name}_COORDINATES {} double\n", values.len());
        list(&mut text, values);
    }
    text += &format!("POINT_DATA {}\n", x.len() * y.len());
    for array in data.arrays.iter().filter(|array| array.axes.len() == 2) {
        text += &format!("SCALARS {} double 1\nLOOKUP_TABLE default\n", array.name);
        list(&mut text, &array.values);
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
