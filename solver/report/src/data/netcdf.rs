//! NetCDF-3 with CF-like coordinates, as xarray reads it.

use super::{CONVENTIONS, Dataset, Fact, UNITS};
use landau_solver::file::seal::BLANK;
use netcdf3::{DataSet, FileWriter, Version};
use std::io::{Read, Seek, SeekFrom};

pub(super) fn encode(data: &Dataset) -> Result<Vec<u8>, String> {
    let text = |e: &dyn std::fmt::Debug| format!("{e:?}");
    let mut set = DataSet::new();
    for (name, value) in &data.attributes {
        let added = match value {
            Fact::Text(value) => set.add_global_attr_string(name, value),
            Fact::Number(value) => set.add_global_attr_f64(name, vec![*value]),
        };
        added.map_err(|e| text(&e))?;
    }
    let conventions = set.add_global_attr_string("Conventions", CONVENTIONS);
    conventions.map_err(|e| text(&e))?;
    let seal = set.add_global_attr_string("seal", BLANK);
    seal.map_err(|e| text(&e))?;
    for axis in &data.axes {
        let added = set.add_fixed_dim(&axis.name, axis.values.len());
        added.map_err(|e| text(&e))?;
        let added = set.add_var_f64(&axis.name, &[&axis.name]);
        added.map_err(|e| text(&e))?;
    }
    for array in &data.arrays {
        let axes = array.axes.iter().map(|&axis| &data.axes[axis].name);
        let added = set.add_var_f64(&array.name, &axes.collect::<Vec<_>>());
        added.map_err(|e| text(&e))?;
    }
    let axes = data.axes.iter().map(|axis| (&axis.name, &axis.long_name));
    for (name, long) in axes.chain(
        data.arrays
            .iter()
            .map(|array| (&array.name, &array.long_name)),
    ) {
        for (fact, value) in [("units", UNITS), ("long_name", long)] {
            let added = set.add_var_attr_string(name, fact, value);
            added.map_err(|e| text(&e))?;
        }
    }
    // The writer wants a file of its own.
    let mut file = tempfile::tempfile().map_err(|e| e.to_string())?;
    let copy = file.try_clone().map_err(|e| e.to_string())?;
    let mut writer =
        FileWriter::open_seek_write("arrays.nc", Box::new(copy)).map_err(|e| text(&e))?;
    writer
        .set_def(&set, Version::Classic, 0)
        .map_err(|e| text(&e))?;
    for axis in &data.axes {
        writer
            .write_var_f64(&axis.name, &axis.values)
            .map_err(|e| text(&e))?;
    }
    for array in &data.arrays {
        writer
            .write_var_f64(&array.name, &array.values)
            .map_err(|e| text(&e))?;
    }
    writer.close().map_err(|e| text(&e))?;
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(0)).map_err(|e| e.to_string())?;
    file.read_to_end(&mut bytes).map_err(|e| e.to_string())?;
    Ok(bytes)
}
