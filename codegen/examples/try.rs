use landau_codegen::*;
fn main() {
    let path = std::env::args().nth(1).unwrap();
    let t = std::time::Instant::now();
    let sources = build::read_sources(std::path::Path::new(&path)).unwrap();
    match generate(&sources) {
        Err(e) => println!("{e}"),
        Ok((d, k)) => {
            if std::env::args().nth(2).is_some() { for s in emit::text::sections(&d) { println!("{}", emit::text::print(&d, s)); } }
            println!("{:?} pairing {:?} parity {:?} ops {:?} nodes {}", t.elapsed(), d.operators.pairing, d.operators.parity, k.structure.operations, d.model.graph.len());
            let code = emit::rust::module(&d, &k);
            println!("{:?} code {} lines", t.elapsed(), code.lines().count());
            std::fs::write("/tmp/code.rs", code).unwrap();
        }
    }
}
