# Gannet. `make help` lists the doors. One Makefile, no recursion: each room (a folder) becomes a
# static library, each programs' folder a program, each file below tests/ a test binary.
# A room that gets a new .cpp needs no line here; a new room needs one line in the table below.

PROFILE ?= release
B       := build/$(PROFILE)
CXX     ?= g++
PREFIX  ?= /usr/local
DESTDIR ?=
VERSION := 0.1.0

ifeq (0,$(MAKELEVEL))  # makes below share this one's jobs
MAKEFLAGS += -j$(shell nproc)
endif

# ---- flags -------------------------------------------------------------------------------------
# -ffp-contract=off: the same bits on every path and machine (docs/design/same-bits.md).
# -ffile-prefix-map: and whatever folder it is built in. Release is hardened as Debian hardens;
# -z now also spares the loops the dynamic linker's first call of each function.
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual \
            -Wcast-qual -Wformat=2 -Wundef -Wvla -Wimplicit-fallthrough -Werror
CXXFLAGS_COMMON := -std=c++20 -g -ffp-contract=off -fno-math-errno -fPIE -ffile-prefix-map=$(CURDIR)=. \
            -I. -isystem /usr/include/eigen3 \
            -DGANNET_VERSION='"$(VERSION)"' $(WARNINGS) -MMD -MP
CXXFLAGS_release := -O2 -fno-omit-frame-pointer -fstack-protector-strong -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2
CXXFLAGS_debug   := -O0 -D_GLIBCXX_ASSERTIONS
CXXFLAGS_asan    := -O1 -g1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=all
CXXFLAGS_tsan    := -O1 -g1 -fno-omit-frame-pointer -fsanitize=thread
LDFLAGS_release  := -Wl,-z,relro,-z,now,--as-needed
LDFLAGS_asan     := -fsanitize=address,undefined
LDFLAGS_tsan     := -fsanitize=thread
CXXFLAGS_ALL = $(CXXFLAGS_COMMON) $(CXXFLAGS_$(PROFILE)) $(CXXFLAGS)
LDFLAGS_ALL  = -pie $(LDFLAGS_$(PROFILE)) $(LDFLAGS) -pthread
ARCH := $(shell $(CXX) -dumpmachine 2>/dev/null | cut -d- -f1)

# ---- rooms: who may use whom --------------------------------------------------------------------
# room: folder; uses: the libraries that it may link, nearest first. tests/style checks #includes.
ROOMS := platform/base platform/linux hal/camera hal/can hal/gpio hal/drive \
         src/core src/search src/vision src/track src/servo src/vehicle src/safety \
         src/config src/telemetry src/control src/modeldb src/image_file src/report
uses_platform/base  :=
uses_platform/linux := platform/base
uses_hal/camera     := platform/linux platform/base
uses_hal/can        := platform/linux platform/base
uses_hal/gpio       := platform/linux platform/base
uses_hal/drive      := hal/can platform/linux platform/base
uses_src/core       := platform/base
uses_src/search     := src/core platform/base
uses_src/vision     := src/core platform/base
uses_src/track      := src/vision src/search src/core platform/base
uses_src/servo      := src/core platform/base
uses_src/vehicle    := src/core platform/base
uses_src/safety     := src/core platform/base
uses_src/config     := src/track src/servo src/vehicle src/safety src/vision src/search hal/drive hal/can hal/camera hal/gpio src/image_file src/core platform/linux platform/base
uses_src/telemetry  := src/core platform/linux platform/base
uses_src/control    := src/core platform/linux platform/base
uses_src/image_file := hal/camera src/core platform/linux platform/base
uses_src/report     := src/image_file hal/camera src/core platform/linux platform/base
uses_src/modeldb    := src/config src/vision src/image_file hal/camera src/core platform/linux platform/base
ALL_ROOMS := src/modeldb src/control src/telemetry src/config src/report src/track src/servo src/vehicle src/safety src/vision src/search hal/drive hal/can hal/camera hal/gpio src/image_file src/core platform/linux platform/base


# Programs: main.cpp in the folder is the program, the other files are its library, so that tests
# can link them.
PROGRAM_gannetd      := src/daemon
PROGRAM_gannet       := src/tool
PROGRAM_gannet-world := src/world
PROGRAMS := $(foreach p,gannetd gannet gannet-world,$(if $(wildcard $(PROGRAM_$p)/main.cpp),$p))
LIBS := -lpng -lturbojpeg
# hal/gpio has a file for each version of libgpiod; the one that is installed decides.
LIBS_GPIO := -lgpiod
GPIOD := $(shell $(or $(PKG_CONFIG),pkg-config) --modversion libgpiod 2>/dev/null)
OTHER_GPIOD := %/gpiod_calls_v$(if $(filter 2.%,$(GPIOD)),1,2).cpp

# ---- sources -> objects -> libraries ------------------------------------------------------------
# Kernel variants: <name>_avx2.cpp, _avx512.cpp and _neon.cpp get their instruction set; only they.
# They include neither Eigen nor inline library code, so that no other room is built with it.
not_here := $(if $(filter x86_64,$(ARCH)),%_neon.cpp,%_avx2.cpp %_avx512.cpp)
sources   = $(filter-out $(not_here) $(OTHER_GPIOD) %/main.cpp,$(wildcard $1/*.cpp $1/*/*.cpp))
objects   = $(patsubst %.cpp,$B/obj/%.o,$(call sources,$1))
library   = $B/lib/$(subst /,_,$1).a
libraries = $(foreach r,$1,$(if $(wildcard $r/*.cpp $r/*/*.cpp),$(call library,$r)))

.SUFFIXES:
.SECONDARY:
.DELETE_ON_ERROR:
.DEFAULT_GOAL := all

all: $(foreach p,$(PROGRAMS),$B/bin/$p)

# Rebuilds everything when compiler or flags change.
$B/flags: FORCE
	@mkdir -p $(@D); echo '$(CXX) $(CXXFLAGS_ALL) / $(LDFLAGS_ALL) $(LIBS)' | cmp -s - $@ || \
	 echo '$(CXX) $(CXXFLAGS_ALL) / $(LDFLAGS_ALL) $(LIBS)' > $@
.PHONY: FORCE  # or .SECONDARY would take it for something that need not be made

$B/obj/%_avx2.o: TARGET_FLAGS := -O3 -mavx2
# g++ 12 warns of its own header's deliberately unset registers (GCC bug 105593).
$B/obj/%_avx512.o: TARGET_FLAGS := -O3 -mavx512f -mavx512bw -mavx512vl -mavx512vnni $(if $(findstring clang,$(CXX)),,-Wno-maybe-uninitialized -Wno-uninitialized)
$B/obj/%_neon.o: TARGET_FLAGS := -O3
$B/obj/%_scalar.o: TARGET_FLAGS := -O3
$B/obj/src/vision/yuv_rows.o $B/obj/src/vision/bent_points.o: TARGET_FLAGS := -O3

$B/obj/%.o: %.cpp $B/flags
	@mkdir -p $(@D)
	@echo "  CXX  $<"
	@$(CXX) $(CXXFLAGS_ALL) $(TARGET_FLAGS) -c $< -o $@

define library_rule
$(call library,$1): $(call objects,$1)
	@mkdir -p $$(@D)
	@echo "  AR   $$@"
	@rm -f $$@; ar rcs $$@ $$^
endef
$(foreach r,$(ROOMS) src/daemon src/tool src/world,$(eval $(call library_rule,$r)))

link = mkdir -p $(@D); echo "  LD   $@"; \
       $(CXX) $(CXXFLAGS_ALL) -o $@ $(filter %.o,$^) -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(LDFLAGS_ALL)

define program_rule
$B/bin/$1: $B/obj/$(PROGRAM_$1)/main.o $(call libraries,$(PROGRAM_$1) $(ALL_ROOMS))
	@$$(link) $(LIBS) $(LIBS_GPIO)
endef
$(foreach p,$(PROGRAMS),$(eval $(call program_rule,$p)))

# ---- tests --------------------------------------------------------------------------------------
# tests/unit/<room>/*.cpp: one binary a room, linked with nothing but what the room may use.
# tests/{golden,stress,rt,system}/*.cpp: one binary a folder, linked with everything.
# tests/*/*.sh: scripts; exit 0 passed, 77 skipped, else failed; $GANNET_BUILD is the build folder.
UNIT_ROOMS := $(foreach r,$(ROOMS) src/daemon src/tool src/world,$(if $(wildcard tests/unit/$r/*.cpp),$r))
BIG_TESTS  := $(foreach t,golden stress rt system,$(if $(wildcard tests/$t/*.cpp),$t))
uses_src/daemon := $(ALL_ROOMS)
uses_src/tool   := $(ALL_ROOMS)
uses_src/world  := $(ALL_ROOMS)
libs_of = $(if $(filter src/image_file src/report src/modeldb src/config src/daemon src/tool src/world,$1),$(LIBS)) \
          $(if $(filter hal/gpio src/config src/modeldb src/daemon src/tool src/world,$1),$(LIBS_GPIO))

define unit_rule
$B/tests/unit/$1/run: $(patsubst %.cpp,$B/obj/%.o,$(wildcard tests/unit/$1/*.cpp)) $(call libraries,$1 $(uses_$1))
	@$$(link) $(call libs_of,$1) -lgtest_main -lgtest
endef
$(foreach r,$(UNIT_ROOMS),$(eval $(call unit_rule,$r)))
define big_rule
$B/tests/$1/run: $(patsubst %.cpp,$B/obj/%.o,$(wildcard tests/$1/*.cpp)) $(call libraries,src/daemon src/tool src/world $(ALL_ROOMS))
	@$$(link) $(LIBS) $(LIBS_GPIO) -lgtest_main -lgtest
endef
$(foreach t,$(BIG_TESTS),$(eval $(call big_rule,$t)))
# ThreadSanitizer has something to say only where threads meet.
THREADED := platform/base platform/linux hal/camera hal/can hal/gpio src/control src/telemetry src/daemon src/world
TESTED_ROOMS := $(if $(filter tsan,$(PROFILE)),$(filter $(THREADED),$(UNIT_ROOMS)),$(UNIT_ROOMS))
TEST_BINARIES := $(foreach r,$(TESTED_ROOMS),$B/tests/unit/$r/run) $(foreach t,$(BIG_TESTS),$B/tests/$t/run)
TEST_SCRIPTS  := $(sort $(wildcard tests/style/*.sh tests/golden/*.sh tests/system/*.sh))

tests: $(TEST_BINARIES)
# One room's tests: make unit/src/vision
unit/%: $B/tests/unit/%/run
	$<

# ---- doors --------------------------------------------------------------------------------------
# A door first installs what is missing, then builds and runs in a make of its own: on a bare
# machine there is no compiler yet that this one could have asked.
PACKAGES_BUILD := g++ libeigen3-dev libtomlplusplus-dev nlohmann-json3-dev libpng-dev libturbojpeg0-dev libgpiod-dev pkg-config
PACKAGES_TEST  := libgtest-dev googletest
PACKAGES_RUN   := ca-certificates
PACKAGES_STYLE := clang-format-14 clang-14
need = tests/support/install.sh $1

help:
	@echo "make              build gannetd, gannet and gannet-world into build/release/bin"
	@echo "make demo         install what is missing, build, and run the main job in the simulated world"
	@echo "make check        install what is missing, build, run all tests that need no privileges"
	@echo "make papers       the papers' experiments, their figures beside ours: SEEDS=3 METHOD=ours ONLY= JOBS=list"
	@echo "make bench        measure kernels, hand-overs and stages against references, in one run"
	@echo "make report       how robust recognition is, beside the published search, as heat maps: TRIALS= SEED= CAMPAIGN=false_locks MINUTES="
	@echo "make bench-peers  beside OpenCV, ViSP and AprilTag on the same rendered views; installs them"
	@echo "make asan, tsan   the tests under AddressSanitizer + UBSan, under ThreadSanitizer"
	@echo "make fuzz         libFuzzer over everything that comes from outside; FUZZ_SECONDS=20 each"
	@echo "make clang        compile everything with clang++, warnings are errors"
	@echo "make arm64        cross-compile for ARM64, run the kernels' tests under qemu"
	@echo "make hil          scenarios on real kernel interfaces in a virtual machine: HIL_SCENARIOS= SEEDS= KVM=1"
	@echo "make docs         write man pages and references from the descriptions in the code"
	@echo "make format       clang-format everything"
	@echo "make install      DESTDIR= PREFIX=/usr/local; enables and starts nothing"
	@echo "make deb          .deb packages into build/deb: this architecture, and arm64 cross-built"
	@echo "make unit/ROOM    the tests of one room, e.g. make unit/src/vision"
	@echo "make clean        remove build/ except what was downloaded"
	@echo "PROFILE=release|debug|asan|tsan   CXX=g++|clang++   CXXFLAGS=…   -jN"

deps:
	@$(call need,$(PACKAGES_BUILD))

check:
	@$(call need,$(PACKAGES_BUILD) $(PACKAGES_TEST) $(PACKAGES_RUN))
	@$(MAKE) --no-print-directory assets
	@$(MAKE) --no-print-directory all tests
	@tests/support/run_tests.sh $B

# The run without the build: what `make check` calls, also for other profiles.
run-tests: all tests
	@tests/support/run_tests.sh $B

asan tsan:
	@$(call need,$(PACKAGES_BUILD) $(PACKAGES_TEST) $(PACKAGES_RUN))
	@$(MAKE) --no-print-directory assets
	@$(MAKE) --no-print-directory PROFILE=$@ run-tests

CLANG_FLAGS = -fsyntax-only $(filter-out -MMD -MP,$(CXXFLAGS_COMMON)) -O1
clang:
	@$(call need,$(PACKAGES_BUILD) $(PACKAGES_TEST) $(PACKAGES_STYLE))
	@git ls-files -co --exclude-standard 'platform/*.cpp' 'hal/*.cpp' 'src/*.cpp' 'tests/unit/*.cpp' \
	   'tests/rt/*.cpp' 'tests/stress/*.cpp' 'tests/system/*.cpp' | grep -v -e _neon.cpp -e $(notdir $(OTHER_GPIOD)) | \
	 xargs -P $(shell nproc) -n 4 tests/support/clang_check.sh $(CLANG_FLAGS)
	@echo "clang: no warnings"

ARM64 := aarch64-linux-gnu
arm64:
	@$(call need,$(PACKAGES_BUILD) $(PACKAGES_TEST) g++-$(ARM64) qemu-user-static)
	@tests/support/arm64.sh $(ARM64)

format:
	@$(call need,$(PACKAGES_STYLE))
	@git ls-files -co --exclude-standard '*.hpp' '*.cpp' | xargs clang-format-14 -i

docs: all
	@tests/support/make_docs.sh $B

# Programs, man pages, scenarios and examples; and what makes gannetd a service. What stands in /etc is
# somebody's and stays. Nothing is enabled or started.
STRIP ?= strip
SHARE  = $(DESTDIR)$(PREFIX)/share
SYSTEM = $(DESTDIR)$(PREFIX)/lib
install: all
	install -d $(DESTDIR)$(PREFIX)/bin $(SHARE)/man/man1 $(SHARE)/man/man5 $(SHARE)/man/man8 \
	  $(SHARE)/gannet/scenarios $(SHARE)/gannet/boards $(SHARE)/gannet/assets \
	  $(SHARE)/doc/gannet/examples $(SHARE)/doc/gannet/guides $(SHARE)/doc/gannet/reference $(DESTDIR)/etc/gannet/gannet.toml.d \
	  $(SYSTEM)/systemd/system $(SYSTEM)/systemd/system-preset $(SYSTEM)/sysusers.d $(SYSTEM)/tmpfiles.d $(SYSTEM)/udev/rules.d
	install $(foreach p,$(PROGRAMS),$B/bin/$p) $(DESTDIR)$(PREFIX)/bin
	$(STRIP) --remove-section=.comment $(foreach p,$(PROGRAMS),$(DESTDIR)$(PREFIX)/bin/$p)
	for n in 1 5 8; do for f in docs/man/*.$$n; do [ ! -e $$f ] || \
	  install -m 644 $$f $(SHARE)/man/man$$n; done; done
	install -m 644 tests/scenarios/*.toml $(SHARE)/gannet/scenarios
	install -m 644 platform/boards/*.toml $(SHARE)/gannet/boards
	for f in $(WORLD_ASSETS); do [ ! -e $$f ] || install -m 644 $$f $(SHARE)/gannet/assets; done
	install -m 644 docs/examples/*.toml $(SHARE)/doc/gannet/examples
	install -m 644 docs/guides/*.md $(SHARE)/doc/gannet/guides
	install -m 644 docs/reference/* $(SHARE)/doc/gannet/reference
	for f in systemd/*.service systemd/*.slice; do \
	  sed 's,/usr/bin/gannet,$(PREFIX)/bin/gannet,g' $$f | \
	  install -m 644 /dev/stdin $(SYSTEM)/systemd/system/$${f##*/}; done
	install -m 644 systemd/preset.conf $(SYSTEM)/systemd/system-preset/80-gannet.preset
	install -m 644 systemd/sysusers.conf $(SYSTEM)/sysusers.d/gannet.conf
	install -m 644 systemd/tmpfiles.conf $(SYSTEM)/tmpfiles.d/gannet.conf
	install -m 644 systemd/udev.rules $(SYSTEM)/udev/rules.d/60-gannet.rules
	[ -e $(DESTDIR)/etc/gannet/gannet.toml ] || install -m 644 systemd/gannet.toml $(DESTDIR)/etc/gannet

clean:
	rm -rf build/hil/results build/hil/cache/ready.*; find build -mindepth 1 -maxdepth 1 ! -name assets ! -name hil -exec rm -rf {} + 2>/dev/null; true

.PHONY: all tests help deps check run-tests asan tsan clang arm64 format docs install clean

include tests/support/assets.mk tests/support/bench.mk tests/support/report.mk tests/support/demo.mk tests/support/fuzz.mk tests/support/papers.mk systemd/deb/deb.mk tests/hil/hil.mk

-include $(shell find $B -name '*.d' 2>/dev/null)
