#[path="../tests/common/mod.rs"] mod common;
use jurist::report::figures::*; use jurist::simulate::*; use jurist::limits::Budget; use jurist::model::Time; use nalgebra::Complex;
fn main(){
  let k1=common::q(381_005_333_483, 10_000_000_000_000); let k2=common::q(550_941_166_686_675, 1_000_000_000_000); let t=common::q(1,10000);
  let o=LocusOptions{lower:common::q(1,1000),upper:common::q(1000,1),scale:ParameterScale::Logarithmic,focus:Complex::new(1.,0.),through:vec![k1.clone(),k2.clone()],reach:2.0};
  let now=std::time::Instant::now();
  let l=trace_root_locus(|k|Some(common::drive_polynomial(k,&t)),&o,&Budget::unlimited()).unwrap();
  eprintln!("{} samples {:?}", l.samples().count(), now.elapsed());
  let f1=0.505696f64*std::f64::consts::TAU*1e-4; let f2=1664.0*std::f64::consts::TAU*1e-4;
  let c=vec![Crossing{parameter:0.0381,at:vec![Complex::from_polar(1.,f1)],label:"K_pwm = 0.0381 (0.506 Hz)".into()},Crossing{parameter:550.94,at:vec![Complex::from_polar(1.,f2)],label:"K_pwm = 550.94 (1664 Hz)".into()}];
  let f=locus_figure(&LocusFigure{time:Time::Discrete,title:"Root locus of K_pwm, 0.001 to 1000 V",parameter:"K_pwm",locus:&l,stable:&[(0.0381005,550.941)],crossings:&c,magnified:None});
  std::fs::write("/tmp/fig/locus.png", f.png(1.5).unwrap()).unwrap();
  std::fs::write("/tmp/fig/locus.svg", f.svg()).unwrap();
  let step=Excitation{initial:vec![],steps:vec![Step{sample:0,input:0,value:80.0}]};
  for k in [545.0,555.0] {
    let lin=common::sampled_drive(k,1e-4).simulate(&step,20000);
    let sw=common::switched_drive(k,1e-4,Pulse::Beginning); let run=sw.simulate(&sw.rest(),&step,20000,Record::Samples);
    let p1=response_panel(&format!("speed, K_pwm = {k} V"),"ω / (rad/s)",&[ResponseCurve{trace:&lin,signal:"omega",label:"sampled linear model"},ResponseCurve{trace:&run.trace,signal:"omega",label:"switched circuit"}]);
    let p2=response_panel(&format!("armature current, K_pwm = {k} V"),"i_a / A",&[ResponseCurve{trace:&lin,signal:"i_a",label:"sampled linear model"},ResponseCurve{trace:&run.trace,signal:"i_a",label:"switched circuit"}]);
    let f=stacked(&[p1,p2],640.,260.);
    std::fs::write(format!("/tmp/fig/resp{k}.png"), f.png(1.5).unwrap()).unwrap();
    std::fs::write(format!("/tmp/fig/resp{k}.svg"), f.svg()).unwrap();
    if k==545.0 { println!("{}", f.terminal(100,40)); }
  }
  let sw=common::switched_drive(110.,1e-4,Pulse::Beginning); let op=sw.periodic_steady_state(&nalgebra::dvector![80.,0.]).unwrap();
  let run=sw.simulate(&op.state,&step,4,Record::Waveform(6));
  let f=stacked(&[response_panel("current ripple","i_a / A",&[ResponseCurve{trace:&run.trace,signal:"i_a",label:""}]),response_panel("chopper voltage","V_a / V",&[ResponseCurve{trace:&run.trace,signal:"V_a",label:""}])],640.,220.);
  std::fs::write("/tmp/fig/ripple.png", f.png(1.5).unwrap()).unwrap();
}
