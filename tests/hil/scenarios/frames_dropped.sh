# Three of ten pairs never arrive. Where two in a row are missing the estimate grows old (at 8 Hz two
# periods more than full_age_s), the ROV holds until the next, and servoes on.
DURATION=11
EVENTS='
  0 s: drop 0.3
'
CHECKS='"found_share > 0.5 after 5 s", "rms_mm < 30 after 6 s"'
play() {
  world_up
  daemon_up
  servoing
  world_ends
}
judge() {
  local from to
  # The journal's word: the play may look only after the first pause. The world lasts longer than to.
  from=$(logged "$(at arm)" 'armed → servoing')
  to=$(plus "$from" 7)
  check "the world lasts to" "$(at figures end)" ">" "$to"
  world_checks
  check "commands to turn" "$(turns_between "$from")" ">" 100
  check "servoing for 7 s" "$(state_share servoing "$from" "$to")" ">" 70 %
  check "servoing or holding" "$(($(state_share servoing "$from" "$to") + $(state_share holding "$from" "$to")))" ">=" 99 %
  check "restarts" "$(value unit NRestarts)" = 0
}
