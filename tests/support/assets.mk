# Photographs for the simulated world and the real stereo pair of the demo, taken out of Debian's
# packages as files, without installing them or what they depend on (docs/design/assets.md).
# `make assets` does nothing where they are. Needs apt's lists (make deps updates them).
ASSETS := build/assets
STAMPS := fish/butterflyfish fish/lionfish fish/seahorse fish/bluegroper fish/coraltrout \
          fish/lobster shellfish/abalone mammals/aquatic/dolphin
STAMP_FILES  := $(addprefix $(ASSETS)/,$(addsuffix .png,$(notdir $(STAMPS)))) $(ASSETS)/fireman.png
STEREO_FILES := $(addprefix $(ASSETS)/,motorcycle_left.png motorcycle_right.png motorcycle_disp.npz \
                  gravel.png)
WORLD_ASSETS := $(STAMP_FILES) $(ASSETS)/gravel.png  # what the simulated world reads

assets: $(STAMP_FILES) $(STEREO_FILES)
.PHONY: assets

# apt drops to the user _apt for downloads, who may not write here: said plainly instead of warned.
apt_download = apt-get -qq $(if $(filter 0,$(shell id -u)),-o APT::Sandbox::User=root) download $1
# $1: package, $2: names inside it
take_out = mkdir -p $(ASSETS)/package && cd $(ASSETS)/package && \
  { ls $1_*.deb >/dev/null 2>&1 || $(call apt_download,$1) || \
    { echo "assets: cannot download $1: run apt-get update, or put its .deb into $(ASSETS)/package" >&2; exit 1; }; } && \
  dpkg-deb --fsys-tarfile $1_*.deb | tar -x --transform='s,.*/,,' -C .. $2

$(STAMP_FILES) &:
	@echo "  GET  tuxpaint-stamps-default"
	@$(call take_out,tuxpaint-stamps-default,$(patsubst %,./usr/share/tuxpaint/stamps/animals/%.png,$(STAMPS)) \
	  ./usr/share/tuxpaint/stamps/people/fireman200b.png)
	@mv $(ASSETS)/fireman200b.png $(ASSETS)/fireman.png; touch $(STAMP_FILES)

$(STEREO_FILES) &:
	@echo "  GET  python3-skimage"
	@$(call take_out,python3-skimage,$(patsubst $(ASSETS)/%,./usr/lib/python3/dist-packages/skimage/data/%,$(STEREO_FILES)))
	@touch $(STEREO_FILES)
