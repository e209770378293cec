# `make demo`: installs what is missing, builds, and shows the main job (tests/support/demo.sh). Like
# the other doors in makes of its own: on a bare machine there is no compiler yet.
demo:
	@$(MAKE) --no-print-directory deps
	@$(MAKE) --no-print-directory assets
	@$(MAKE) --no-print-directory all
	@tests/support/demo.sh $B build/demo
.PHONY: demo
