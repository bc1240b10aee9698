use jurist::report::figures::*;
fn main(){
  for (n,f) in [("f1",drive_blocks()),("f2",chopper()),("f3",pwm_signal()),("f4",current_controller()),("f6",tracker())] {
    std::fs::write(format!("/tmp/fig/{n}.png"), f.png(1.5).unwrap()).unwrap();
    std::fs::write(format!("/tmp/fig/{n}.svg"), f.svg()).unwrap();
  }
}
