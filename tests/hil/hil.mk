# `make hil`: scenarios on the kernel's real interfaces, in a virtual machine (tests/hil/README.md).
PACKAGES_HIL := qemu-system-x86 mmdebstrap fakeroot busybox-static cpio e2fsprogs kmod make xz-utils dpkg-dev
# The foreign readers of the recorded buses (decode.sh).
PACKAGES_HIL += tshark python3-can
PACKAGES_HIL_ARM64 := qemu-system-arm g++-$(ARM64) googletest
HIL_SCENARIOS ?=
SEEDS ?= 1
hil:
	@$(call need,$(PACKAGES_BUILD) $(PACKAGES_HIL))
	@$(MAKE) --no-print-directory assets
	@$(MAKE) --no-print-directory deb-native
ifneq (,$(if $(HIL_SCENARIOS),$(filter arm64,$(HIL_SCENARIOS)),all))
	@$(call need,$(PACKAGES_HIL_ARM64))
	@$(MAKE) --no-print-directory deb-arm64
endif
	@SEEDS=$(SEEDS) tests/hil/run $(HIL_SCENARIOS)
.PHONY: hil
