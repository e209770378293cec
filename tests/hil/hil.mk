# `make hil`: scenarios on the kernel's real interfaces, in a virtual machine (tests/hil/README.md).
PACKAGES_HIL := qemu-system-x86 mmdebstrap fakeroot busybox-static cpio e2fsprogs kmod make xz-utils
HIL_SCENARIOS ?=
SEEDS ?= 1
hil:
	@$(call need,$(PACKAGES_BUILD) $(PACKAGES_HIL) dpkg-dev)
	@$(MAKE) --no-print-directory assets
	@$(MAKE) --no-print-directory deb-native
	@SEEDS=$(SEEDS) tests/hil/run $(HIL_SCENARIOS)
.PHONY: hil
