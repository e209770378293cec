# Two cameras of the kernel's own test driver, vivid: one is unplugged and comes back, frames are
# dropped, one carries the error flag. The daemon stays up and takes them up again.
play() {
  modprobe vivid n_devs=2 node_types=0x1,0x1 num_inputs=1,1 input_types=0,0 vid_cap_nr=20,21
  udevadm settle
  gannet cameras >$OUT/cameras
  camera=$(printf '%s\n' 'width = 320' 'height = 180' 'fx = 320' 'fy = 320' 'cx = 160' 'cy = 90')
  cat >/etc/gannet/rig.toml <<END
format = 1
[left]
$camera
[right]
$camera
[right_from_left]
rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]
translation_m = [-0.12, 0, 0]
END
  cat >/etc/gannet/gannet.toml <<'END'
format = 1
rig = "rig.toml"
[camera]
kind = "v4l2_pair"
[camera.v4l2_pair]
left = "/dev/video20"
right = "/dev/video21"
width = 320
height = 180
rate_hz = 25
pair_tolerance_s = 0.019
[vehicle]
kind = "none"
[can]
kind = "memory"
END
  daemon_up
  sleep 1
  figures before
  mark disconnect
  v4l2-ctl -d /dev/video20 -c disconnect=1
  sleep 2
  figures unplugged
  v4l2-ctl -d /dev/video20 -c inject_v4l2_buf_flag_error=1
  sleep 0.5
  figures flagged
  v4l2-ctl -d /dev/video21 -c percentage_of_dropped_buffers=30
  sleep 2
}
judge() {
  check "pairs before" "$(value top-before drops.frames)" ">" 15
  check "told that the cameras are silent" "$(ms "$(at disconnect)" "$(logged "$(at disconnect)" 'cameras are silent')")" "<" 700 ms
  check "back, without a restart" "$(ms "$(at disconnect)" "$(logged "$(at disconnect)" 'cameras are back')")" "<" 1500 ms
  check "restarts" "$(value unit NRestarts)" = 0 times
  check "frames with the error flag" "$(value top-flagged cameras.error_flagged)" = 1
  check "images missed of 30 % dropped" "$(value top-end cameras.missed)" ">" 8
}
