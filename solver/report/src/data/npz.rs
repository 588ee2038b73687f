//! npz: one npy file an axis and an array; attributes as JSON text in the bytes of `attributes`. The seal is
//! the comment of the archive.

use super::{Dataset, Fact};
use landau_solver::file::seal::BLANK;
use npyz::WriterBuilder;
use std::io::{Cursor, Write};
use zip::write::{SimpleFileOptions, ZipWriter};

pub(super) fn encode(data: &Dataset) -> Result<Vec<u8>, String> {
    // The same bytes on every run: no time of day, no compression.
    let options = SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Stored)
        .last_modified_time(zip::DateTime::default());
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let mut add = |name: &str, bytes: Vec<u8>| -> Result<(), String> {
        archive
            .start_file(format!("{name}.npy"), options)
            .map_err(|e| e.to_string())?;
        archive.write_all(&bytes).map_err(|e| e.to_string())
    };
    for axis in &data.axes {
        add(&axis.name, npy(&[axis.values.len() as u64], &axis.values)?)?;
    }
    for array in &data.arrays {
        let shape: Vec<u64> = array
            .axes
            .iter()
            .map(|&axis| data.axes[axis].values.len() as u64)
            .collect();
        add(&array.name, npy(&shape, &array.values)?)?;
    }
    let attributes: serde_json::Map<String, serde_json::Value> = data
        .attributes
        .iter()
        .map(|(name, value)| {
            let value = match value {
                Fact::Text(text) => text.clone().into(),
                Fact::Number(number) => (*number).into(),
            };
            (name.clone(), value)
        })
        .collect();
    let text = serde_json::to_string(&attributes).map_err(|e| e.to_string())?;
    add("attributes", npy(&[text.len() as u64], text.as_bytes())?)?;
    archive.set_comment(BLANK).map_err(|e| e.to_string())?;
    let finished = archive.finish().map_err(|e| e.to_string())?;
    Ok(finished.into_inner())
}

fn npy<T: npyz::AutoSerialize + Copy>(shape: &[u64], values: &[T]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let mut writer = npyz::WriteOptions::<T>::new()
        .default_dtype()
        .shape(shape)
        .writer(&mut bytes)
        .begin_nd()
        .map_err(|e| e.to_string())?;
    writer
        .extend(values.iter().copied())
        .map_err(|e| e.to_string())?;
    writer.finish().map_err(|e| e.to_string())?;
    Ok(bytes)
}
