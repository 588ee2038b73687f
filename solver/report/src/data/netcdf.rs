//! NetCDF-3 with CF-like coordinates, as xarray reads it.

use super::Dataset;
use netcdf3::{DataSet, FileWriter, Version};
use std::io::{Read, Seek, SeekFrom};

pub(super) fn encode(data: &Dataset) -> Result<Vec<u8>, String> {
    let text = |e: &dyn std::fmt::Debug| format!("{e:?}");
    let mut set = DataSet::new();
    for (name, value) in &data.attributes {
        set.add_global_attr_string(name, value)
            .map_err(|e| text(&e))?;
    }
    for (name, values) in &data.axes {
        set.add_fixed_dim(name, values.len())
            .map_err(|e| text(&e))?;
        set.add_var_f64(name, &[name]).map_err(|e| text(&e))?;
    }
    for array in &data.arrays {
        let axes: Vec<&String> = array.axes.iter().map(|&axis| &data.axes[axis].0).collect();
        set.add_var_f64(&array.name, &axes).map_err(|e| text(&e))?;
    }
    // The writer wants a file of its own.
    let mut file = tempfile::tempfile().map_err(|e| e.to_string())?;
    let copy = file.try_clone().map_err(|e| e.to_string())?;
    let mut writer =
        FileWriter::open_seek_write("arrays.nc", Box::new(copy)).map_err(|e| text(&e))?;
    writer
        .set_def(&set, Version::Classic, 0)
        .map_err(|e| text(&e))?;
    for (name, values) in &data.axes {
        writer.write_var_f64(name, values).map_err(|e| text(&e))?;
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
