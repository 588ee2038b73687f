use landau_solver::{base, model::*, parameters::Parameters, problem::Problem, collocation::Discretisation, weakly::*, spectrum};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let sources = landau_codegen::build::read_sources(std::path::Path::new(&a[1])).unwrap();
    let model = TapeModel::new(&sources).unwrap();
    let s = model.structure();
    let mut p = Parameters::defaults(s);
    for kv in &a[4..] { let (n,v) = kv.split_once('=').unwrap(); p.set_text(s,n,v).unwrap(); }
    let b = base::solve(&model,&p).unwrap();
    for m in a[3].split(',') {
        let m: usize = m.parse().unwrap();
        let d = Discretisation::new();
        let pr = Problem::new(&model,&b,&d,m).unwrap();
        for k in a[2].split(',') {
            let k: f64 = k.parse().unwrap();
            let t = std::time::Instant::now();
            let ev = spectrum::eigenvalues(&pr,k).map(|e| e[..e.len().min(4)].to_vec());
            let ea = spectrum::adjoint_eigenvalues(&pr,k).map(|e| e[..e.len().min(4)].to_vec());
            println!("M {m} k {k}\n  {ev:.10?}\n  {ea:.10?} {:?}", t.elapsed());
            let t = std::time::Instant::now();
            match point(&pr,k,Selection::Leading) {
                Ok(pt) => { println!("  c0 {:.13?} c2 {:.13?} A {:?} {} mult {:?} out {:?} {:?}", pt.c0, pt.c2, pt.amplitude(), pt.bifurcation(), pt.expansion.multipliers, outputs(&pt), t.elapsed());
                   let t = std::time::Instant::now();
                   for _ in 0..10 { warm_point(&pr, k*1.001, &pt.expansion.pair).unwrap(); }
                   println!("  warm {:?}", t.elapsed()/10);
                   let pair = pt.expansion.pair.clone();
                   let t = std::time::Instant::now();
                   for _ in 0..10 { spectrum::follow(&pr, k*1.001, &pair).unwrap(); }
                   println!("  follow {:?}", t.elapsed()/10);
 }
                Err(e) => println!("  {e}"),
            }
        }
    }
}
