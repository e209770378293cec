# `make fuzz`: each libFuzzer entry of tests/fuzz for FUZZ_SECONDS under AddressSanitizer and UBSan.
# A finding stops with its input kept and the line that repeats it; what was learned stays in
# build/fuzz/corpus for the next time.
FUZZ_SECONDS ?= 20
CXXFLAGS_fuzz := -O1 -g1 -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
LDFLAGS_fuzz  := -fsanitize=fuzzer,address,undefined
FUZZED  := src/image_file hal/drive hal/can hal/camera src/core platform/linux platform/base
FUZZERS := $(patsubst tests/fuzz/%_fuzz.cpp,$B/fuzz/%,$(wildcard tests/fuzz/*_fuzz.cpp))
$B/fuzz/%: $B/obj/tests/fuzz/%_fuzz.o $(call libraries,$(FUZZED))
	@$(link) $(LIBS)
fuzzers: $(FUZZERS)

fuzz:
	@$(call need,$(PACKAGES_BUILD) clang-14 libclang-rt-14-dev)
	@$(MAKE) --no-print-directory PROFILE=fuzz CXX=clang++-14 fuzzers
	@tests/support/fuzz.sh build/fuzz/fuzz $(FUZZ_SECONDS)
.PHONY: fuzz fuzzers
