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
.PHONY: bench
