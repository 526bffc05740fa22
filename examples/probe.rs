use fretwear::contact::InitialContact;
use fretwear::friction::Coulomb;
use fretwear::half_space::HalfSpace;
use fretwear::indenter::Indenter;
use fretwear::loading::*;
use fretwear::model::Model;
use fretwear::stepper::*;
use fretwear::wear::Archard;
fn main() {
    let a: Vec<f64> = std::env::args().skip(1).take(5).map(|s| s.parse().unwrap()).collect();
    let (n, k, c, springs, tol) = (a[0], a[1], a[2], a[3] as usize, a[4]);
    let taus: Vec<f64> = std::env::args().skip(6).map(|s| s.parse().unwrap()).collect();
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
    let model = Model::new(
        &contact,
        springs,
        if std::env::var("QUAD").is_ok() {
            fretwear::grid::Clustering::Quadratic
        } else {
            fretwear::grid::Clustering::Cubic
        },
    )
    .unwrap();
    let t1 = t0.elapsed();
    let mut state = model.initial_state().unwrap();
    let tpc = contact.tau_per_cycle();
    let f = model.fields(&state);
    println!(
        "a0 {} edge {} rate {} wmax {:e} Vinf {:e} build {:?}",
        contact.contact_radius(),
        state.edge,
        model.wear_rate(&f, &state.compression) / tpc,
        model.depth_scale(),
        std::f64::consts::PI
            * model.unworn().limit_edge()
            * fretwear::linear::dot(model.operators().depth_sum(), &model.limit_depth())
            / d,
        t1
    );
    let kind = std::env::var("STEPPER").unwrap_or_default();
    let mut st: Box<dyn Stepper> = if kind == "jump" {
        Box::<CycleJump>::default()
    } else if kind == "every" {
        Box::<EveryCycle>::default()
    } else {
        Box::new(Implicit::new(tol))
    };
    let every: f64 = std::env::var("DTAU").map(|s| s.parse().unwrap()).unwrap_or(1e-3);
    let mut h = 1e-3 / tpc;
    let (mut steps, mut rej, mut ev) = (0, 0, 0);
    let t0 = std::time::Instant::now();
    for tau in taus {
        let end = tau / tpc;
        while state.cycles < end {
            let clip = end - state.cycles;
            let hh = if kind == "every" { every / tpc } else { h.min(clip) };
            let t = st.step(&model, &state, hh).unwrap();
            ev += t.rate_evaluations;
            let err = t.error / tol;
            if let (Some(s), true) = (t.state, err <= 1.0) {
                state = s;
                steps += 1;
                if hh == clip && kind != "every" {
                    state.cycles = end;
                }
                if kind == "every" && end - state.cycles < 0.5 * hh {
                    break;
                }
                h = if hh == h || err > 0.5 { hh * (0.9 * err.powf(-1.0 / 3.0)).clamp(0.3, 2.5) } else { h };
            } else {
                rej += 1;
                h = hh * if err.is_finite() { (0.9 * err.powf(-1.0 / 3.0)).clamp(0.2, 0.9) } else { 0.25 };
                if h * tpc < 1e-12 {
                    panic!("step {h} at {}", state.cycles * tpc)
                }
            }
        }
        let f = model.fields(&state);
        let r = model.radial_fields(&f);
        let lim = model.limit_depth();
        let dist = r.wear_depth.iter().zip(&lim).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            / model.depth_scale();
        println!(
            "tau {tau} V {:.9} a {:.8} dist {dist:e} E/V {:e} rate {:e} steps {steps} rej {rej} ev {ev} {:?}",
            model.wear_volume(&f) / d,
            model.contact_radius(&state) / contact.contact_radius(),
            state.dissipated_energy / model.wear_volume(&f) - 1.0,
            model.wear_rate(&f, &state.compression) / tpc,
            t0.elapsed()
        );
    }
}
