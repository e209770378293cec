# `make deb`: Debian packages in build/deb, for this machine's architecture and cross-built for arm64.
# Dated by the last commit: the same sources give the same bytes, in whatever folder.
DEB_ARCH       := $(shell dpkg --print-architecture 2>/dev/null)
DEB_MAINTAINER ?= Gannet maintainers <gannet@example.org>
SOURCE_DATE_EPOCH ?= $(shell git log -1 --format=%ct 2>/dev/null || stat -c %Y Makefile)
deb_env = SOURCE_DATE_EPOCH=$(SOURCE_DATE_EPOCH) VERSION=$(VERSION) MAINTAINER='$(DEB_MAINTAINER)' \
          COMMIT=$$(git describe --always --dirty 2>/dev/null || echo unknown)
# A folder that is empty, whatever an earlier run left there. $1: architecture
stage = rm -rf build/deb/stage-$1 && $(MAKE) --no-print-directory install DESTDIR=$(CURDIR)/build/deb/stage-$1 PREFIX=/usr

deb:
	@$(call need,$(PACKAGES_BUILD) dpkg-dev)
	@$(MAKE) --no-print-directory assets
	@$(MAKE) --no-print-directory deb-native
	@[ "$(DEB_ARCH)" = arm64 ] || $(MAKE) --no-print-directory deb-arm64

deb-native:
	@$(MAKE) --no-print-directory all
	@+$(call stage,$(DEB_ARCH)) >/dev/null
	@$(deb_env) systemd/deb/build.sh $(DEB_ARCH) build/deb/stage-$(DEB_ARCH) build/deb

# Cross-built: libraries of arm64 from Debian, unpacked below build/arm64; nothing is installed.
SYSROOT := build/arm64/sysroot
SYSLIB  := $(SYSROOT)/tree/usr/lib/$(ARM64)
cross   := B=build/arm64/release CXX=$(ARM64)-g++ STRIP=$(ARM64)-strip \
           PKG_CONFIG='env PKG_CONFIG_LIBDIR=$(SYSLIB)/pkgconfig pkg-config' \
           CXXFLAGS='-g0 -isystem $(SYSROOT)/tree/usr/include' \
           LDFLAGS='-L$(SYSLIB) -L$(SYSROOT)/tree/lib/$(ARM64) -Wl,-rpath-link,$(SYSLIB):$(SYSROOT)/tree/lib/$(ARM64)'
deb-arm64:
	@$(call need,g++-$(ARM64) dpkg-dev)
	@systemd/deb/sysroot.sh arm64 $(SYSROOT) libpng-dev libturbojpeg0-dev libgpiod-dev libstdc++6
	@$(MAKE) --no-print-directory all $(cross)
	@+$(call stage,arm64) $(cross) >/dev/null
	@$(deb_env) systemd/deb/build.sh arm64 build/deb/stage-arm64 build/deb \
	  $(CURDIR)/$(SYSROOT)/dpkg $(CURDIR)/$(SYSROOT)/tree/lib/$(ARM64) $(CURDIR)/$(SYSLIB)
.PHONY: deb deb-native deb-arm64
