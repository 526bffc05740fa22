use fretwear::contact::InitialContact;
use fretwear::friction::Coulomb;
use fretwear::grid::*;
use fretwear::half_space::HalfSpace;
use fretwear::indenter::Indenter;
use fretwear::loading::*;
use fretwear::model::Model;
use fretwear::simulation::*;
use fretwear::stepper::*;
use fretwear::wear::Archard;
struct Rec {
    v: Vec<f64>,
    w: Vec<Vec<f64>>,
    e: Vec<f64>,
    a: Vec<f64>,
}
impl Observer for Rec {
    fn output(&mut self, s: &Simulation) -> fretwear::Result<()> {
        if s.state().cycles == 0.0 {
            return Ok(());
        }
        let v = s.model().wear_volume(s.fields());
        self.v.push(v);
        self.w.push(s.model().radial_fields(s.fields()).wear_depth);
        self.e.push((s.state().dissipated_energy - v).abs());
        self.a.push(s.model().contact_radius(s.state()));
        Ok(())
    }
}
fn run(n: f64, k: f64, c: f64, springs: usize, tol: f64) -> (Rec, Vec<f64>, f64, f64, u64, f64) {
    let indenter = Indenter::power_law(1.0, n).unwrap();
    let hs = HalfSpace::from_stiffness(k, 1.0, 1.0).unwrap();
    let d = fretwear::indenter::power_law_factor(n, k);
    let loading = Loading {
        load: Load::Indentation(d),
        amplitude: Amplitude::StickRatio(c),
        duration: Duration::Tau(30.0),
    };
    let contact = InitialContact::new(
        &indenter,
        &hs,
        &Coulomb { coefficient: 1.0 },
        &Archard { coefficient: 1.0 },
        &loading,
    )
    .unwrap();
    let t0 = std::time::Instant::now();
    let model = Model::new(&contact, springs, Clustering::Cubic).unwrap();
    // time unit that makes different scenes comparable: 1/(kappa p_mean)
    let unit = 3.0 / contact.tau_per_cycle() * d / contact.slip_compression();
    let outputs: Vec<f64> = (0..16).map(|i| 0.1 * unit * 1.6f64.powi(i)).collect();
    let end = End::Cycles(*outputs.last().unwrap());
    let (xi, vinf, scale) = (
        model.operators().nodes().to_vec(),
        std::f64::consts::PI
            * model.unworn().limit_edge()
            * fretwear::linear::dot(model.operators().depth_sum(), &model.limit_depth()),
        model.depth_scale(),
    );
    let mut sim = Simulation::new(model, Box::new(Implicit::new(tol)), tol, Plan { outputs, end }).unwrap();
    let mut rec = Rec { v: vec![], w: vec![], e: vec![], a: vec![] };
    sim.run(&mut [&mut rec]).unwrap();
    (rec, xi, vinf, scale, sim.progress().steps, t0.elapsed().as_secs_f64())
}
fn interp(xi: &[f64], w: &[f64], x: f64, mu: f64) -> f64 {
    let last = xi.len() - 1;
    let mut cell = 1;
    while cell + 1 < last && xi[cell + 1] < x {
        cell += 1;
    }
    let s = stencil_start(cell, 4, last);
    let mut l = [0.0; 4];
    lagrange(&xi[s..s + 4], x, &mut l);
    (0..4).map(|m| l[m] * w[s - 1 + m] * xi[s + m].powf(-mu)).sum::<f64>() * x.powf(mu)
}
fn main() {
    let all = [
        (2.0, 0.0, 0.7),
        (2.0, 0.0, 0.3),
        (2.0, -0.5, 0.7),
        (2.0, 0.5, 0.7),
        (2.0, 0.9, 0.7),
        (1.0, -0.3, 0.5),
        (1.0, 0.0, 0.9),
        (4.0, 0.3, 0.2),
        (2.0, -0.8, 0.5),
        (2.0, 0.0, 0.97),
        (0.5, 0.0, 0.5),
        (2.0, 0.0, 0.05),
    ];
    let only: Option<usize> = std::env::var("ONLY").ok().map(|v| v.parse().unwrap());
    for (i, (n, k, c)) in all.into_iter().enumerate() {
        if only.is_some_and(|o| o != i) {
            continue;
        }
        let mu = 0.5 * (1.0 - k);
        let (r, xr, vinf, scale, _, _) = run(n, k, c, 360, 1e-7);
        print!("({n},{k},{c}) N:");
        for springs in [24, 36, 54, 80, 120, 180] {
            let (s, xi, ..) = run(n, k, c, springs, 1e-7);
            let ev = s.v.iter().zip(&r.v).map(|(a, b)| (a - b).abs() / vinf).fold(0.0, f64::max);
            if std::env::var("T").is_ok() {
                for (t, (a, b)) in s.w.iter().zip(&r.w).enumerate() {
                    let m = (1..xi.len())
                        .map(|i| ((a[i - 1] - interp(&xr, b, xi[i], mu)) / scale, i, xi[i], a[i - 1] / scale))
                        .max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
                        .unwrap();
                    println!(
                        "{springs} {t} {:.2e} {} {:.2e} {:.2e} edge {:.4}",
                        m.0,
                        m.1,
                        m.2,
                        m.3,
                        (s.a[t].powi(2) - c * c) / (s.a.last().unwrap().powi(2) - c * c)
                    );
                }
            }
            let ee = s.e.iter().map(|e| e / vinf).fold(0.0, f64::max);
            let ew = s
                .w
                .iter()
                .zip(&r.w)
                .map(|(a, b)| {
                    (1..xi.len()).map(|i| (a[i - 1] - interp(&xr, b, xi[i], mu)).abs()).fold(0.0, f64::max)
                        / scale
                })
                .fold(0.0, f64::max);
            print!(" {springs}: V {ev:.1e} w {ew:.1e} est {ee:.1e} |");
        }
        println!();
        print!("    tol:");
        let (r, ..) = run(n, k, c, 60, 1e-8);
        for tol in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
            let (s, _, _, _, steps, t) = run(n, k, c, 60, tol);
            let ev = s.v.iter().zip(&r.v).map(|(a, b)| (a - b).abs() / vinf).fold(0.0, f64::max);
            let ew =
                s.w.iter()
                    .zip(&r.w)
                    .map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / scale)
                    .fold(0.0, f64::max);
            print!(" {tol}: V {ev:.1e} w {ew:.1e} steps {steps} {:.0}ms |", t * 1e3);
        }
        println!();
    }
}
