//! Random scenes of every kind: every indenter, law, history, mode, block, control, duration, and key of numerics and output, in real units
//! and scales, alone and together. A scene is a function of its seed.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use fretwear::scene::Scene;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// How long the runs of the scenes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Length {
    /// Up to a hundredth of the dimensionless time, on few springs.
    Short,
    /// As users ask for them.
    Usual,
    /// At the ends of every range, with the numerics left to the program.
    Extreme,
}

/// A scene and the files that it names.
#[derive(Debug, Clone)]
pub struct RandomScene {
    pub seed: u64,
    pub text: String,
    /// Name and content.
    pub files: Vec<(&'static str, String)>,
}

impl RandomScene {
    pub fn new(seed: u64, length: Length) -> Self {
        let extreme = length == Length::Extreme;
        let mut draw = Draw { generator: ChaCha8Rng::seed_from_u64(seed), files: vec![], extreme };
        let text = draw.scene(length);
        Self { seed, text, files: draw.files }
    }

    /// Writes scene and files into a folder, and reads them.
    pub fn read(&self, folder: &Path) -> fretwear::Result<Scene> {
        for (name, content) in &self.files {
            fs::write(folder.join(name), content).expect("a file in a scratch folder");
        }
        let path = folder.join("scene.toml");
        fs::write(&path, &self.text).expect("a file in a scratch folder");
        Scene::from_path(&path)
    }
}

/// What of the contact other keys refer to; of the order of size, not exact.
struct Sizes {
    depth: f64,
    radius: f64,
    grading: f64,
    normal_stiffness: f64,
    stiffness_ratio: f64,
    friction: f64,
    wear: f64,
}

impl Sizes {
    fn pressure(&self) -> f64 {
        self.normal_stiffness * self.radius.powf(self.grading - 1.0) * self.depth
    }

    fn force(&self) -> f64 {
        self.pressure() * self.radius * self.radius
    }

    fn tau_per_cycle(&self) -> f64 {
        4.0 * self.wear * self.pressure() * self.friction / self.stiffness_ratio
    }

    fn stiffness(&self) -> f64 {
        self.stiffness_ratio * self.normal_stiffness * self.radius.powf(1.0 + self.grading)
    }
}

struct Draw {
    generator: ChaCha8Rng,
    files: Vec<(&'static str, String)>,
    extreme: bool,
}

impl Draw {
    fn unit(&mut self) -> f64 {
        (self.generator.next_u64() >> 11) as f64 * (-53.0_f64).exp2()
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in the logarithm.
    fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn chance(&mut self, part: f64) -> bool {
        self.unit() < part
    }

    fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    fn one_of<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }

    /// A number, or a string with one of some units, each with its factor.
    fn quantity(&mut self, value: f64, units: &[(&str, f64)]) -> String {
        if units.is_empty() || self.chance(0.5) {
            return format!("{value:?}");
        }
        let (unit, factor) = self.one_of(units);
        format!("\"{:?} {unit}\"", value / factor)
    }

    fn length(&mut self, metres: f64) -> String {
        self.quantity(metres, &[("um", 1e-6), ("mm", 1e-3), ("nm", 1e-9)])
    }

    fn scene(&mut self, length: Length) -> String {
        let mut text = String::new();
        if self.chance(0.1) {
            text += "title = \"a random scene\"\n";
        }
        let (indenter, mut sizes) = self.indenter();
        text += &indenter;
        text += &self.half_space(&mut sizes);
        // All times of histories and blocks go by one clock.
        let clock = if self.chance(0.7) { "tau" } else { "cycles" };
        let end = match length {
            Length::Short => self.scale(1e-5, 1e-2),
            Length::Usual => self.scale(1e-4, 300.0),
            Length::Extreme => self.scale(1e-6, 1e5),
        };
        [sizes.friction, sizes.wear] = [self.between(0.05, 1.2), self.scale(1e-18, 1e-12)];
        if self.extreme {
            // Wear of a cycle from some 1e-15 of the limit's depth to beyond it.
            let cycles = if self.chance(0.2) { self.scale(1e-2, 1.0) } else { self.scale(1.0, 1e12) };
            sizes.wear *= end / (cycles * sizes.tau_per_cycle());
        }
        text += &self.friction(&sizes, clock, end);
        text += &self.wear(&sizes, clock, end);
        // What is refused by its keys alone tells nothing of extremes.
        let keeps_displacement = self.extreme && text.contains("static-kinetic");
        text += &self.loading(&sizes, clock, end, keeps_displacement);
        text += &self.numerics(length);
        if self.chance(0.05)
            && !(self.extreme && ["orbit]", "oscillation]", "path]"].iter().any(|it| text.contains(it)))
        {
            let from = format!("[loading]\nwear_from = \"{}\"\n", self.one_of(&["settled", "first-cycle"]));
            text = text.replacen("[loading]\n", &from, 1);
        }
        text += &self.output(end, length);
        text
    }

    fn indenter(&mut self) -> (String, Sizes) {
        let radius = if self.extreme { self.scale(1e-9, 1e3) } else { self.scale(1e-6, 1e-2) };
        let depth = radius * self.scale(1e-6, 3e-2);
        let sizes = Sizes {
            depth,
            radius,
            grading: 0.0,
            normal_stiffness: 0.0,
            stiffness_ratio: 0.0,
            friction: 0.0,
            wear: 0.0,
        };
        let curvature = radius * radius / depth;
        let text = match self.below(6) {
            0 | 1 => format!("[indenter.paraboloid]\nradius = {}\n", self.length(curvature)),
            2 => format!("[indenter.sphere]\nradius = {}\n", self.length(curvature)),
            3 if self.chance(0.5) => format!("[indenter.cone]\nslope = {:?}\n", depth / radius),
            3 => {
                let angle = (radius / depth).atan().to_degrees();
                format!("[indenter.cone]\nhalf_angle = \"{angle:?} deg\"\n")
            }
            4 => {
                let exponent = match self.one_of(&[0, 1, 2]) {
                    _ if self.extreme => self.scale(0.1, 20.0),
                    0 => self.one_of(&[1.0, 2.0, 3.0, 4.0]),
                    1 => self.between(0.3, 3.0),
                    _ => self.scale(0.3, 15.0),
                };
                let coefficient = depth / radius.powf(exponent);
                format!("[indenter.power-law]\ncoefficient = {coefficient:?}\nexponent = {exponent:?}\n")
            }
            _ => self.table(radius, depth),
        };
        (text, sizes)
    }

    /// Rows of a smooth profile, now and then of a rough one or of one that ends early.
    fn table(&mut self, radius: f64, depth: f64) -> String {
        let rows = 6 + self.below(200);
        let reach = if self.chance(0.1) { 1.1 } else { self.between(2.0, 6.0) };
        let exponent = self.between(1.0, 4.0);
        let wave = if self.chance(0.3) { self.scale(1e-4, 0.3) } else { 0.0 };
        let noise = if self.chance(0.15) { self.scale(1e-6, 1e-2) } else { 0.0 };
        let (units, [by_radius, by_height]) = if self.chance(0.5) {
            ("radius_unit = \"um\"\nprofile_unit = \"nm\"\n", [1e6, 1e9])
        } else {
            ("", [1.0, 1.0])
        };
        let mut file = String::from("# r, f\n");
        for row in 0..rows {
            let part = reach * row as f64 / (rows - 1) as f64;
            let smooth = part.powf(exponent) * (1.0 + wave * (6.0 * part).sin());
            let height = if row == 0 { 0.0 } else { (smooth + noise * self.unit()).max(0.0) };
            writeln!(file, "{:?}, {:?}", by_radius * radius * part, by_height * depth * height)
                .expect("a string takes all");
        }
        self.files.push(("profile.csv", file));
        format!("[indenter.table]\nfile = \"profile.csv\"\n{units}")
    }

    fn half_space(&mut self, sizes: &mut Sizes) -> String {
        let grading = match self.below(4) {
            1 | 2 if self.extreme => self.one_of(&[-1.0, 1.0]) * (1.0 - self.scale(1e-4, 1.0)),
            0 => self.one_of(&[0.0, 0.5, -0.5, 0.3, -0.3]),
            1 | 2 => self.between(-0.3, 0.9),
            _ => self.between(-0.99, 0.99),
        };
        sizes.grading = grading;
        let mut text = format!("[half_space]\ngrading = {grading:?}\n");
        if self.chance(0.5) {
            let modulus = self.scale(1e6, 1e12);
            let depth = self.scale(1e-4, 1.0);
            let gigapascal = [("GPa", 1e9), ("MPa", 1e6), ("kPa", 1e3)];
            let written = self.quantity(modulus, &gigapascal);
            let poisson = match self.below(3) {
                0 => "\"similar\"".into(),
                _ => format!("{:?}", self.between(0.05, 0.45)),
            };
            writeln!(
                text,
                "modulus = {written}\nreference_depth = {}\npoisson_ratio = {poisson}",
                self.length(depth)
            )
            .expect("a string takes all");
            (sizes.normal_stiffness, sizes.stiffness_ratio) = (modulus / depth.powf(grading), 0.8);
        } else {
            sizes.normal_stiffness = self.scale(1e6, 1e12);
            writeln!(text, "normal_stiffness = {:?}", sizes.normal_stiffness).expect("a string takes all");
            sizes.stiffness_ratio = 1.0;
            if self.chance(0.8) {
                sizes.stiffness_ratio = self.between(0.3, 1.5);
                writeln!(text, "stiffness_ratio = {:?}", sizes.stiffness_ratio).expect("a string takes all");
            }
        }
        if self.chance(0.1) {
            let stiffness = sizes.normal_stiffness * self.scale(0.1, 10.0);
            text += &format!("[counter_body]\nnormal_stiffness = {stiffness:?}\nstiffness_ratio = 0.8\n");
            sizes.normal_stiffness = (sizes.normal_stiffness.recip() + stiffness.recip()).recip();
        }
        text
    }

    fn friction(&mut self, sizes: &Sizes, clock: &str, end: f64) -> String {
        let coefficient = sizes.friction;
        let mut text = match self.below(6) {
            2 if self.extreme => {
                let last = coefficient * self.between(0.5, 1.5);
                // Some part of what is dissipated up to the end.
                let slip = 4.0 * coefficient * sizes.depth / sizes.stiffness_ratio;
                let density = sizes.pressure() * slip * end / sizes.tau_per_cycle() * self.scale(1e-2, 10.0);
                format!(
                    "[friction.wear-dependent]\nfirst_coefficient = {coefficient:?}\nlast_coefficient = {last:?}\nenergy_density = {density:?}\n"
                )
            }
            0 => {
                let kinetic = coefficient * self.between(0.5, 1.0);
                format!(
                    "[friction.static-kinetic]\nstatic_coefficient = {coefficient:?}\nkinetic_coefficient = {kinetic:?}\n"
                )
            }
            1 => {
                let exponent = self.between(-0.6, 1.5);
                let mut text = format!(
                    "[friction.load-dependent]\ncoefficient = {coefficient:?}\nexponent = {exponent:?}\n"
                );
                if self.chance(0.3) {
                    let depth = sizes.depth * self.scale(0.1, 10.0);
                    text += &format!("reference_compression = {}\n", self.length(depth));
                }
                text
            }
            _ => format!("[friction.coulomb]\ncoefficient = {coefficient:?}\n"),
        };
        let alone = self.extreme && text.contains("wear-dependent");
        if self.chance(0.25) && !alone {
            text += &self.history("friction", false, sizes, clock, end);
        }
        text
    }

    fn wear(&mut self, sizes: &Sizes, clock: &str, end: f64) -> String {
        let coefficient = sizes.wear;
        let written = self.quantity(coefficient, &[("1/MPa", 1e-6), ("mm^3/(N m)", 1e-9)]);
        let mut text = match self.below(9) {
            4 if self.extreme => self.friction_power(sizes),
            0 => format!("[wear.dissipated-energy]\ncoefficient = {:?}\n", coefficient / sizes.friction),
            1 => {
                let [by_pressure, by_slip] = [self.between(0.4, 2.0), self.between(0.4, 2.0)];
                let slip = 4.0 * sizes.friction * sizes.depth / sizes.stiffness_ratio;
                let factor =
                    coefficient * sizes.pressure().powf(1.0 - by_pressure) * slip.powf(1.0 - by_slip);
                format!(
                    "[wear.power-law]\ncoefficient = {factor:?}\npressure_exponent = {by_pressure:?}\nslip_exponent = {by_slip:?}\n"
                )
            }
            2 => {
                let pressure = sizes.pressure() * self.scale(1e-3, 3.0);
                let written_pressure = self.quantity(pressure, &[("MPa", 1e6), ("kPa", 1e3)]);
                format!("[wear.threshold]\ncoefficient = {written}\npressure = {written_pressure}\n")
            }
            3 => {
                let spread = sizes.radius * self.scale(1e-3, 2.0);
                format!("[wear.non-local]\ncoefficient = {written}\nlength = {}\n", self.length(spread))
            }
            _ => format!("[wear.archard]\ncoefficient = {written}\n"),
        };
        if self.chance(0.2) {
            text += &self.history("wear", true, sizes, clock, end);
        }
        text
    }

    fn friction_power(&mut self, sizes: &Sizes) -> String {
        let coefficient = sizes.wear / sizes.friction;
        // Of the order of size of p s at a cycle per second.
        let power = sizes.pressure() * 4.0 * sizes.friction.powi(2) * sizes.depth / sizes.stiffness_ratio;
        let scope = self.one_of(&["global", "local"]);
        let form = if self.chance(0.5) {
            let decay = self.scale(1e-2, 1e2) / power;
            let adhesive = coefficient * self.between(0.1, 0.9);
            format!(
                "abrasive_coefficient = {coefficient:?}\nadhesive_coefficient = {adhesive:?}\ndecay = {decay:?}"
            )
        } else {
            let exponent = self.between(-0.6, 1.0);
            format!("coefficient = {coefficient:?}\nexponent = {exponent:?}\nreference_power = {power:?}")
        };
        format!("[wear.friction-power]\nscope = \"{scope}\"\n{form}\n")
    }

    /// A time within the run or somewhat beyond, by the clock of the scene.
    fn time(&mut self, sizes: &Sizes, clock: &str, end: f64) -> f64 {
        let tau = match self.below(3) {
            // As people write them; sums of these differ by rounding from the same numbers written out.
            0 => end * 0.1 * (1 + self.below(12)) as f64,
            1 => end * self.unit().max(1e-3),
            _ => end * self.scale(1e-3, 10.0),
        };
        if clock == "tau" { tau } else { tau / sizes.tau_per_cycle() }
    }

    fn history(&mut self, law: &str, ends_at_zero: bool, sizes: &Sizes, clock: &str, end: f64) -> String {
        let mut text = format!("[{law}.history]\n");
        if self.chance(0.5) {
            let factor = match self.below(4) {
                0 if ends_at_zero => 0.0,
                1 => self.scale(1.0, 3.0),
                _ => self.between(0.2, 1.0),
            };
            let time = self.time(sizes, clock, end);
            text += &format!("final_factor = {factor:?}\n{clock} = {time:?}\n");
            return text;
        }
        let mut times: Vec<f64> = (0..1 + self.below(4)).map(|_| self.time(sizes, clock, end)).collect();
        if self.chance(0.5) {
            times.push(0.0);
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        // Half of them go one way.
        let direction = self.one_of(&[-1.0, 0.0, 0.0, 1.0]);
        let mut factor = 1.0;
        let factors = times.iter().map(|_| {
            let change = self.between(0.0, 0.3);
            factor *= if direction == 0.0 { 1.0 + 2.0 * change - 0.3 } else { 1.0 + direction * change };
            factor
        });
        let factors: Vec<f64> = factors.collect();
        text += &format!("factors = {factors:?}\nat_{clock} = {times:?}\n");
        text
    }

    /// The compression at the edge of stick over the indentation: from stick through partial slip and the transition to gross slip.
    fn severity(&mut self) -> f64 {
        if self.extreme {
            return match self.below(6) {
                0 => self.scale(1e-10, 1e-2),
                1 => 1.0 - self.scale(1e-9, 1e-1),
                2 => 1.0 + self.scale(1e-9, 1e-1),
                3 => self.scale(1.0, 100.0),
                _ => self.between(0.01, 0.95),
            };
        }
        match self.below(12) {
            0 => 0.0,
            1 => self.scale(1e-9, 1e-2),
            2 => 1.0 - self.scale(1e-9, 1e-1),
            3 => 1.0,
            4 => 1.0 + self.scale(1e-9, 1e-1),
            5 => self.between(1.0, 4.0),
            _ => self.between(0.01, 0.95),
        }
    }

    fn loading(&mut self, sizes: &Sizes, clock: &str, end: f64, keeps_displacement: bool) -> String {
        let mut text = String::from("[loading]\n");
        let load = match self.below(5) {
            0 => format!("normal_force = {:?}\n", sizes.force() * self.scale(0.3, 3.0)),
            1 => format!("initial_force = {:?}\n", sizes.force() * self.scale(0.3, 3.0)),
            _ => format!("indentation = {}\n", self.length(sizes.depth)),
        };
        text += &load;
        let mode = if self.chance(0.25) { 1 + self.below(3) } else { 0 };
        let severity = self.severity();
        let ratio = severity / sizes.stiffness_ratio;
        let amplitude = ratio * sizes.friction * sizes.depth;
        if mode != 3 {
            let written = match self.below(4) {
                0 => format!("amplitude = {}\n", self.length(amplitude)),
                1 | 2 => format!("amplitude_ratio = {ratio:?}\n"),
                _ if self.chance(0.05) => "stick_ratio = 1.0\n".into(),
                _ => format!("stick_ratio = {:?}\n", self.between(0.02, 0.999)),
            };
            text += &written;
        }
        if self.extreme {
            text += "frequency = 1.0\n";
        }
        text += &match self.below(8) {
            0 => format!(
                "until_rate = {:?}\n",
                if self.chance(0.3) { self.scale(1e-18, 1e-9) } else { self.scale(1e-6, 0.99) }
            ),
            1 | 2 => format!("cycles = {:?}\n", (end / sizes.tau_per_cycle()).ceil().max(1.0)),
            _ => format!("tau = {end:?}\n"),
        };
        match self.below(if mode == 0 { 6 } else { 12 }) {
            0 | 1 if self.extreme && (mode != 0 || keeps_displacement) => {}
            0 => text += "tangential_control = \"force\"\n",
            1 => {
                let stiffness = sizes.stiffness() * self.scale(0.1, 100.0);
                let written = self.quantity(stiffness, &[("kN/m", 1e3), ("MN/m", 1e6)]);
                if self.chance(0.5) {
                    text += "tangential_control = \"rig\"\n";
                }
                text += &format!("rig_stiffness = {written}\n");
            }
            _ => {}
        }
        let blocks = if self.chance(0.25) { 1 + self.below(4) } else { 0 };
        if blocks > 0 && self.chance(0.4) {
            text += "repeat = true\n";
        }
        let direction = self.one_of(&[-1.0, 0.0, 0.0, 1.0]);
        let deeper = self.chance(if self.extreme { 0.1 } else { 0.3 });
        let mut tables = String::new();
        let mut factor = 1.0;
        for _ in 0..blocks {
            let time = self.time(sizes, clock, end);
            tables += &format!("[[loading.blocks]]\n{clock} = {time:?}\n");
            let change = self.between(0.0, 0.4);
            factor *= if direction == 0.0 { 0.7 + 2.0 * change } else { 1.0 + direction * change };
            tables += &format!("amplitude_factor = {:?}\n", if self.chance(0.03) { 0.0 } else { factor });
            if deeper {
                tables += &format!("indentation_factor = {:?}\n", self.between(0.6, 1.5));
            }
        }
        match mode {
            1 => tables += &self.normal_oscillation(sizes),
            2 => tables += &self.orbit(amplitude),
            3 => tables += &self.path(sizes, amplitude),
            _ => {}
        }
        text + &tables
    }

    fn phase(&mut self) -> String {
        let degrees = self.one_of(&[0.0, 35.0, 90.0, 180.0, 270.0]);
        if self.chance(0.5) { format!("phase = \"{degrees:?} deg\"\n") } else { String::new() }
    }

    fn normal_oscillation(&mut self, sizes: &Sizes) -> String {
        let part = self.scale(1e-3, 0.95);
        let amplitude = if self.chance(0.5) {
            format!("amplitude_ratio = {part:?}")
        } else {
            format!("amplitude = {}", self.length(part * sizes.depth))
        };
        let ratio = self.one_of(&["1", "2", "0.5", "\"3/2\"", "\"5/4\"", "3"]);
        format!("[loading.normal_oscillation]\n{amplitude}\nfrequency_ratio = {ratio}\n{}", self.phase())
    }

    fn orbit(&mut self, amplitude: f64) -> String {
        let part = self.scale(1e-2, 3.0);
        let transverse = if self.chance(0.5) || amplitude == 0.0 {
            format!("transverse_ratio = {part:?}")
        } else {
            format!("transverse_amplitude = {}", self.length(part * amplitude))
        };
        let mut text = format!("[loading.orbit]\n{transverse}\n{}", self.phase());
        if self.chance(0.3) {
            let centre = amplitude * self.between(-1.0, 1.0);
            text += &format!("centre_x = {}\n", self.length(centre));
        }
        text
    }

    fn path(&mut self, sizes: &Sizes, amplitude: f64) -> String {
        let rows = 3 + self.below(30);
        let (amplitude, lift) = (
            amplitude.max(1e-3 * sizes.friction * sizes.depth),
            if self.chance(0.5) { 0.0 } else { sizes.depth * self.scale(1e-3, 0.6) },
        );
        let around = self.one_of(&[0.0, 0.3, 1.0]);
        let mut file = String::from("x, y, indentation\n");
        for row in 0..rows {
            let angle = std::f64::consts::TAU * row as f64 / rows as f64;
            let [x, y] = [amplitude * angle.cos(), around * amplitude * angle.sin()];
            let indentation = lift * (2.0 * angle).sin();
            writeln!(file, "{x:?}, {y:?}, {indentation:?}").expect("a string takes all");
        }
        self.files.push(("path.csv", file));
        "[loading.path]\nfile = \"path.csv\"\n".into()
    }

    fn numerics(&mut self, length: Length) -> String {
        let mut text = String::from("[numerics]\n");
        if self.extreme {
            text += &format!("accuracy = {:?}\n", self.one_of(&[1e-2, 1e-3, 1e-4]));
            return text;
        }
        let short = length == Length::Short;
        if self.chance(0.6) || short {
            let finest = if short { 1e-3 } else { 1e-6 };
            text += &format!("accuracy = {:?}\n", self.scale(finest, 0.1));
        }
        if self.chance(0.25) {
            let most = if short { 70.0 } else { 200.0 };
            text += &format!("springs = {}\n", self.scale(8.0, most) as usize);
        }
        if self.chance(0.2) {
            text += &format!("tolerance = {:?}\n", self.scale(1e-7, 0.1));
        }
        if self.chance(0.15) {
            let stepper = self.one_of(&["every-cycle", "cycle-jump", "implicit"]);
            text += &format!("stepper = \"{stepper}\"\n");
        }
        if self.chance(0.15) {
            text += &format!("cycle = \"{}\"\n", self.one_of(&["resolved", "resolved", "closed-form"]));
        }
        if self.chance(0.2) || short {
            let most = if short { 16.0 } else { 200.0 };
            text += &format!("substeps = {}\n", self.scale(2.0, most) as usize);
        }
        if self.chance(0.1) {
            text += "checkpoint_interval = \"1 h\"\n";
        }
        text
    }

    fn output(&mut self, end: f64, length: Length) -> String {
        let most = match length {
            Length::Short => 4,
            Length::Usual => 60,
            Length::Extreme => 20,
        };
        let count = 1 + self.below(most);
        match self.below(4) {
            0 => String::new(),
            _ if self.extreme => format!("[output]\nsnapshots = {count}\n"),
            1 => format!("[output]\nsnapshots = {count}\n"),
            2 => {
                let times = (0..count).map(|i| end * 0.1 * ((i % 10) + 1) as f64);
                let times: Vec<f64> = times.filter(|tau| *tau <= end).collect();
                format!("[output]\nat_tau = {times:?}\n")
            }
            _ => {
                let times: Vec<f64> = (1..count).map(|i| (1u64 << (i % 40)) as f64).collect();
                format!("[output]\nat_cycles = {times:?}\n")
            }
        }
    }
}
