# `make bench`: all measurements in one run; figures also in build/bench/results.json. The binary is
# built with the tests too, for tests/system/bench_test.cpp runs it with --quick.
BENCH := $B/tests/bench/run
$(BENCH): $(patsubst %.cpp,$B/obj/%.o,$(wildcard tests/bench/*.cpp)) $(call libraries,src/world $(ALL_ROOMS))
	@$(link) $(LIBS) $(LIBS_GPIO)
tests: $(BENCH)

bench:
	@$(call need,$(PACKAGES_BUILD) rt-tests)
	@$(MAKE) --no-print-directory $(BENCH) all assets
	@mkdir -p build/bench
	@GANNET_BUILD=$B $(BENCH) --json build/bench/results.json --flags "$$(cat $B/flags)" \
	  --commit "$$(git describe --always --dirty 2>/dev/null)"

# `make bench-peers`: Gannet beside OpenCV, ViSP and AprilTag on the same rendered views. A program of its
# own; nothing else is built with, or links, what it installs.
HAS_VISP := $(wildcard /usr/include/*/visp3/tt/vpTemplateTracker.h)
PEERS := $B/tests/bench/peers/run
$B/obj/tests/bench/peers/%.o: TARGET_FLAGS := -isystem /usr/include/opencv4
$B/obj/tests/bench/peers/visp_template.o: TARGET_FLAGS := -isystem /usr/include/opencv4 -std=c++17
$(PEERS): $(patsubst %.cpp,$B/obj/%.o,$(wildcard tests/bench/peers/*.cpp) $(patsubst %,tests/bench/%.cpp,measure results workload cluttered_scene)) \
          $(call libraries,src/world $(ALL_ROOMS))
	@$(link) $(LIBS) $(LIBS_GPIO) -lopencv_video -lopencv_calib3d -lopencv_features2d -lopencv_imgproc -lopencv_core -lapriltag -lapriltag-utils $(if $(HAS_VISP),-lvisp_tt -lvisp_vision -lvisp_core)

bench-peers:
	@$(call need,$(PACKAGES_BUILD) libopencv-dev libapriltag-dev libvisp-tt-dev)
	@$(MAKE) --no-print-directory $(PEERS)
	@mkdir -p build/bench
	@$(PEERS) --json build/bench/peers.json --flags "$$(cat $B/flags)" \
	  --commit "$$(git describe --always --dirty 2>/dev/null)"
.PHONY: bench bench-peers
