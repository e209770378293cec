# The main job from a cold start of the service.
play() {
  gannet-world /hil/scenario.toml --live --attach /etc/gannet/world --seed $SEED --record $OUT/world >$OUT/world.log 2>&1 &
  world=$!
  for i in $(seq 100); do [ -e /etc/gannet/world/gannetd.toml ] && break; sleep 0.1; done
  sleep 0.5
  mkdir -p /run/gannet
  mark start
  gannetd -c /etc/gannet/world/gannetd.toml --set control.socket=/etc/gannet/world/control --set track.evaluations=800 --set track.evaluations_tracking=100 --set track.model_points=200 &
  wait $world
}
judge() { :; }
