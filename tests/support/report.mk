# `make report`: how robust recognition is against light, turbidity, occlusion, distractors, blur,
# distance and tilt, beside the published search: build/report/report.html and results.json. The
# binary is built with the tests too, for tests/system/robustness.sh runs a little of it.
REPORT := $B/tests/report/run
$(REPORT): $(patsubst %.cpp,$B/obj/%.o,$(wildcard tests/report/*.cpp)) $(call libraries,src/world $(ALL_ROOMS))
	@$(link) $(LIBS) $(LIBS_GPIO)
tests: $(REPORT)

# CAMPAIGN=false_locks MINUTES=60: an hour of footage without the target, and a third with it, instead.
TRIALS ?= 15
SEED   ?= 1
MINUTES ?= 2
CAMPAIGN ?=
report:
	@$(call need,$(PACKAGES_BUILD))
	@$(MAKE) --no-print-directory $(REPORT) assets
	@$(REPORT) --out build/report --trials $(TRIALS) --seed $(SEED) $(if $(filter false_locks,$(CAMPAIGN)),--false-locks $$(($(MINUTES) * 60)))
.PHONY: report
