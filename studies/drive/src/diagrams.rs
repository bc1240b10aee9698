//! The drive's diagrams: loop, chopper, modulator, controllers, tracker.

use jurist_draw::figures::{COLOURS, Figure, Sketch};

/// The speed control loop: two cascaded controllers, modulator, chopper, motor.
pub fn drive_blocks() -> Figure {
    let mut s = Sketch::new(1000.0, 240.0);
    let y = 90.0;
    s.arrow(&[(20.0, y), (69.0, y)]);
    s.label((42.0, y - 10.0), "ω_ref");
    s.sum((80.0, y));
    s.label((68.0, y + 26.0), "−");
    s.arrow(&[(91.0, y), (130.0, y)]);
    s.block((190.0, y), (120.0, 56.0), &["speed", "controller G_cs"]);
    s.arrow(&[(250.0, y), (299.0, y)]);
    s.label((272.0, y - 10.0), "I_ref");
    s.sum((310.0, y));
    s.label((298.0, y + 26.0), "−");
    s.arrow(&[(321.0, y), (360.0, y)]);
    s.block((420.0, y), (120.0, 56.0), &["current", "controller G_ci"]);
    s.arrow(&[(480.0, y), (530.0, y)]);
    s.label((504.0, y - 10.0), "E_c");
    s.block((578.0, y), (96.0, 56.0), &["PWM", "0 … E_sw"]);
    s.arrow(&[(626.0, y), (676.0, y)]);
    s.label((650.0, y - 10.0), "t_on");
    s.block((728.0, y), (104.0, 56.0), &["chopper", "0 or K_pwm"]);
    s.arrow(&[(780.0, y), (826.0, y)]);
    s.label((802.0, y - 10.0), "V_a");
    s.block((876.0, y), (100.0, 76.0), &["DC motor", "J, B_v, K_a", "R_a, L_a"]);
    s.arrow(&[(876.0, 12.0), (876.0, y - 38.0)]);
    s.label_left((884.0, 26.0), "T_L");
    s.arrow(&[(926.0, y), (985.0, y)]);
    s.label((968.0, y - 10.0), "ω");
    s.joint((946.0, y));
    s.wire(&[(850.0, y + 38.0), (850.0, 168.0), (450.0, 168.0)]);
    s.label_left((856.0, 150.0), "i_a");
    s.block((420.0, 168.0), (60.0, 34.0), &["k_1"]);
    s.arrow(&[(390.0, 168.0), (310.0, 168.0), (310.0, y + 11.0)]);
    s.wire(&[(946.0, y), (946.0, 214.0), (450.0, 214.0)]);
    s.block((420.0, 214.0), (60.0, 34.0), &["k_2"]);
    s.arrow(&[(390.0, 214.0), (80.0, 214.0), (80.0, y + 11.0)]);
    s.finish()
}

/// The class-C chopper, and its voltage and current.
pub fn chopper() -> Figure {
    let mut s = Sketch::new(900.0, 360.0);
    s.label((210.0, 350.0), "(a) class-C chopper");
    // Supply.
    s.wire(&[(80.0, 60.0), (80.0, 165.0)]);
    s.wire(&[(62.0, 165.0), (98.0, 165.0)]);
    s.line(&[(70.0, 173.0), (90.0, 173.0)], "#222222", 4.0, None);
    s.wire(&[(80.0, 173.0), (80.0, 300.0)]);
    s.label_right((56.0, 174.0), "K_pwm");
    s.wire(&[(80.0, 60.0), (230.0, 60.0)]);
    s.wire(&[(80.0, 300.0), (390.0, 300.0)]);
    // Two switches, each with its diode, in a leg.
    for (top, switch, diode) in [(60.0, "S_1", "D_2"), (180.0, "S_2", "D_1")] {
        s.wire(&[(150.0, top), (150.0, top + 40.0)]);
        s.wire(&[(150.0, top + 40.0), (168.0, top + 78.0)]);
        s.wire(&[(150.0, top + 80.0), (150.0, top + 120.0)]);
        s.circle((150.0, top + 40.0), 2.8, "#222222");
        s.circle((150.0, top + 80.0), 2.8, "#222222");
        s.label_right((142.0, top + 64.0), switch);
        s.wire(&[(230.0, top), (230.0, top + 50.0)]);
        s.filled(&[(230.0, top + 50.0), (220.0, top + 68.0), (240.0, top + 68.0)]);
        s.wire(&[(219.0, top + 50.0), (241.0, top + 50.0)]);
        s.wire(&[(230.0, top + 68.0), (230.0, top + 120.0)]);
        s.label_left((246.0, top + 64.0), diode);
    }
    s.joint((150.0, 60.0));
    s.joint((150.0, 300.0));
    s.joint((230.0, 300.0));
    s.wire(&[(150.0, 180.0), (300.0, 180.0)]);
    s.joint((150.0, 180.0));
    s.joint((230.0, 180.0));
    // Armature.
    s.arrow(&[(262.0, 170.0), (294.0, 170.0)]);
    s.label((278.0, 160.0), "i_a");
    s.wire(&[(300.0, 180.0), (390.0, 180.0)]);
    s.block((390.0, 202.0), (26.0, 28.0), &[]);
    s.label_left((410.0, 207.0), "R_a");
    s.wire(&[(390.0, 180.0), (390.0, 188.0)]);
    let turn = |y: f64| [(404.0, y), (404.0, y + 12.0), (390.0, y + 12.0)];
    s.curves((390.0, 216.0), &[turn(216.0), turn(228.0), turn(240.0)]);
    s.label_left((410.0, 238.0), "L_a");
    s.wire(&[(390.0, 252.0), (390.0, 258.0)]);
    s.circle((390.0, 274.0), 16.0, "white");
    s.label((390.0, 278.0), "M");
    s.label_left((410.0, 280.0), "K_a ω");
    s.wire(&[(390.0, 290.0), (390.0, 300.0)]);
    s.label_left((310.0, 250.0), "V_a");
    s.arrow(&[(340.0, 292.0), (340.0, 188.0)]);
    waveforms(&mut s);
    s.finish()
}

/// Voltage and current of the chopper.
fn waveforms(s: &mut Sketch) {
    let (left, period) = (540.0, 110.0);
    for (base, name) in [(150.0, "V_a"), (300.0, "i_a")] {
        s.arrow(&[(left, base), (885.0, base)]);
        s.arrow(&[(left, base), (left, base - 115.0)]);
        s.label_right((left - 8.0, base - 100.0), name);
        s.label((880.0, base + 18.0), "t");
    }
    let duty = 0.4;
    for k in 0..3 {
        let x = left + f64::from(k) * period;
        let off = x + duty * period;
        let colour = COLOURS[0];
        s.line(&[(x, 150.0), (x, 70.0), (off, 70.0), (off, 150.0), (x + period, 150.0)], colour, 2.0, None);
        s.line(&[(x, 262.0), (off, 232.0), (x + period, 262.0)], COLOURS[1], 2.0, None);
        for at in [x, off] {
            s.line(&[(at, 150.0), (at, 300.0)], "#aaaaaa", 0.8, Some(&[3.0, 3.0]));
        }
    }
    s.label_right((left - 8.0, 74.0), "K_pwm");
    s.label((left + 22.0, 168.0), "t_on");
    s.label((left + period + 9.0, 168.0), "T");
    s.label((left + 2.0 * period + 13.0, 168.0), "2T");
    s.label((710.0, 350.0), "(b) voltage and current");
}

/// The modulator: control voltage against the sawtooth.
pub fn pwm_signal() -> Figure {
    let mut s = Sketch::new(760.0, 330.0);
    let (left, period, base, top) = (90.0, 150.0, 160.0, 50.0);
    s.arrow(&[(left, base), (740.0, base)]);
    s.arrow(&[(left, base), (left, 20.0)]);
    s.arrow(&[(left, 300.0), (740.0, 300.0)]);
    s.arrow(&[(left, 300.0), (left, 200.0)]);
    s.label_right((left - 8.0, top + 4.0), "E_sw");
    s.label_right((left - 8.0, 224.0), "K_pwm");
    let level = |k: i32| [0.45, 0.6, 0.35, 0.5][k as usize % 4];
    for k in 0..4 {
        let x = left + f64::from(k) * period;
        s.line(&[(x, base), (x + period, top), (x + period, base)], "#222222", 1.4, None);
        let (e, off) = (base - level(k) * (base - top), x + level(k) * period);
        s.line(&[(x, e), (x + period, e)], COLOURS[1], 2.0, None);
        s.line(&[(x, 300.0), (x, 220.0), (off, 220.0), (off, 300.0), (x + period, 300.0)], COLOURS[0], 2.0, None);
        s.line(&[(off, e), (off, 300.0)], "#999999", 0.8, Some(&[3.0, 3.0]));
        let tick = if k == 0 { "nT".to_string() } else { format!("(n+{k})T") };
        s.label((x, 318.0), &tick);
    }
    s.label_left((left + 8.0, base - 0.45 * (base - top) - 6.0), "E_c(n)");
    s.label((left + 0.22 * period, 290.0), "t_on");
    s.label((735.0, base + 18.0), "t");
    s.label((735.0, 318.0), "t");
    s.label_left((left + 8.0, 206.0), "V_a");
    s.finish()
}

/// A PI controller with one sample of delay and trapezoidal integration, with the names of its signals and of its gains.
fn controller([reference, measured, output]: [&str; 3], [gain, kp, ki]: [&str; 3], name: char) -> Figure {
    let mut s = Sketch::new(820.0, 240.0);
    let y = 80.0;
    s.arrow(&[(20.0, y), (79.0, y)]);
    s.label((46.0, y - 10.0), reference);
    s.sum((90.0, y));
    s.label((78.0, y + 26.0), "−");
    s.arrow(&[(20.0, 190.0), (60.0, 190.0)]);
    s.label((36.0, 180.0), measured);
    s.block((90.0, 190.0), (60.0, 34.0), &[gain]);
    s.arrow(&[(90.0, 173.0), (90.0, y + 11.0)]);
    s.wire(&[(101.0, y), (170.0, y)]);
    s.label((142.0, y - 10.0), &format!("e_{name}(n)"));
    s.joint((170.0, y));
    s.arrow(&[(170.0, y), (250.0, y)]);
    s.block((290.0, y), (80.0, 44.0), &["1/z"]);
    s.arrow(&[(330.0, y), (520.0, y)]);
    s.label((424.0, y - 10.0), &format!("ε_1{name}(n)"));
    s.block((560.0, y), (80.0, 44.0), &[kp]);
    s.arrow(&[(600.0, y), (689.0, y)]);
    s.arrow(&[(170.0, y), (170.0, 180.0), (215.0, 180.0)]);
    s.block((310.0, 180.0), (190.0, 50.0), &["T (z + 1)", "2 z (z − 1)"]);
    s.wire(&[(240.0, 180.0), (380.0, 180.0)]);
    s.arrow(&[(405.0, 180.0), (520.0, 180.0)]);
    s.label((462.0, 170.0), &format!("ε_2{name}(n)"));
    s.block((560.0, 180.0), (80.0, 44.0), &[ki]);
    s.arrow(&[(600.0, 180.0), (700.0, 180.0), (700.0, y + 11.0)]);
    s.sum((700.0, y));
    s.arrow(&[(711.0, y), (800.0, y)]);
    s.label((762.0, y - 10.0), output);
    s.finish()
}

/// The current controller.
pub fn current_controller() -> Figure {
    controller(["I_ref(n)", "i_a(n)", "E_c(n)"], ["k_1", "K_pi", "K_ii"], 'i')
}

/// The speed controller.
pub fn speed_controller() -> Figure {
    controller(["ω_ref(n)", "ω(n)", "I_ref(n)"], ["k_2", "K_ps", "K_is"], 's')
}

/// The tracker with output feedback.
pub fn tracker() -> Figure {
    let mut s = Sketch::new(820.0, 280.0);
    let y = 100.0;
    s.arrow(&[(20.0, y), (90.0, y)]);
    s.label((52.0, y - 10.0), "r(n)");
    s.block((120.0, y), (60.0, 40.0), &["E"]);
    s.arrow(&[(150.0, y), (279.0, y)]);
    s.sum((290.0, y));
    s.arrow(&[(301.0, y), (400.0, y)]);
    s.label((350.0, y - 10.0), "x(n+1)");
    s.block((440.0, y), (80.0, 40.0), &["I/z"]);
    s.arrow(&[(480.0, y), (600.0, y)]);
    s.label((528.0, y - 10.0), "x(n)");
    s.block((630.0, y), (60.0, 40.0), &["C"]);
    s.arrow(&[(660.0, y), (800.0, y)]);
    s.label((770.0, y - 10.0), "y(n)");
    s.joint((560.0, y));
    s.wire(&[(560.0, y), (560.0, 40.0), (470.0, 40.0)]);
    s.block((440.0, 40.0), (60.0, 36.0), &["A"]);
    s.arrow(&[(410.0, 40.0), (290.0, 40.0), (290.0, y - 11.0)]);
    s.joint((720.0, y));
    s.arrow(&[(720.0, y), (720.0, 220.0), (560.0, 220.0)]);
    s.block((530.0, 220.0), (60.0, 40.0), &["−K"]);
    s.arrow(&[(500.0, 220.0), (400.0, 220.0)]);
    s.label((450.0, 210.0), "u(n)");
    s.block((370.0, 220.0), (60.0, 40.0), &["B"]);
    s.arrow(&[(340.0, 220.0), (290.0, 220.0), (290.0, y + 11.0)]);
    s.finish()
}
