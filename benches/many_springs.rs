//! Cost of an evaluation and of a factorisation for many springs.
use std::time::Instant;

use fretwear::grid::Clustering;
use fretwear::model::Model;
use fretwear::scene::Scene;

fn main() {
    let scene = Scene::from_toml(include_str!("../data/scenes/paraboloid.toml"), "scene").unwrap();
    let contact = scene.contact().unwrap();
    for n in std::env::args().filter_map(|it| it.parse::<usize>().ok()) {
        let begin = Instant::now();
        let model = Model::new(&contact, n, Clustering::Smooth).unwrap();
        let set_up = begin.elapsed().as_secs_f64();
        let begin = Instant::now();
        let state = model.initial_state().unwrap();
        let start = begin.elapsed().as_secs_f64();
        let mut fields = model.fields(&state);
        let drive = model.schedule().drive(0.0, 0.0);
        let mut cycle = model.cycle(&drive, &state.compression, &fields);
        let time = |f: &mut dyn FnMut()| {
            let mut best = f64::INFINITY;
            for _ in 0..5 {
                let begin = Instant::now();
                f();
                best = best.min(begin.elapsed().as_secs_f64());
            }
            best
        };
        let evaluation = time(&mut || {
            model.evaluate(state.edge, &state.compression, &mut fields);
            cycle = model.cycle(&drive, &state.compression, &fields);
        });
        let step = 0.1 / contact.tau_per_cycle();
        let by_edge = model.log_slip_by_edge(&fields);
        let mut factors = None;
        let factorise = time(&mut || {
            let slopes = model.plain_growth_slopes(&drive, &fields, &cycle, -step).unwrap();
            factors = model.stage_factors(&fields, 1e-3, slopes, &by_edge);
        });
        let factors = factors.unwrap();
        let mut rhs: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let solve = time(&mut || factors.solve(&mut rhs));
        let mut out = vec![0.0; n];
        let apply = time(&mut || model.operators().transforms()[0].apply(&state.compression, &mut out));
        println!(
            "{n}: set-up {set_up:.2} s, start {start:.2} s, apply {:.2} ms evaluation {:.2} ms, factors {:.1} ms {} B/spring, solve {:.2} ms",
            apply * 1e3,
            evaluation * 1e3,
            factorise * 1e3,
            factors.bytes() / n,
            solve * 1e3
        );
    }
}
