# `make papers`: the papers' experiments in simulation (docs/guides/papers.md). SEEDS, METHOD (ours,
# papers, both), ONLY (one experiment); JOBS=list prints a command for each run and runs nothing.
METHOD ?= ours
# make hil has SEEDS of its own, which is another number unless it is given.
PAPER_SEEDS = $(if $(filter file undefined,$(origin SEEDS)),3,$(SEEDS))
papers:
ifeq ($(JOBS),list)
	@$(MAKE) --no-print-directory -s all >&2
	@$B/bin/gannet-world paper $(ONLY) --jobs build/papers/runs --seeds $(PAPER_SEEDS) --method $(METHOD)
else
	@$(MAKE) --no-print-directory deps
	@$(MAKE) --no-print-directory assets
	@$(MAKE) --no-print-directory all
	@tests/papers/run.sh $B build/papers $(PAPER_SEEDS) $(METHOD) $(ONLY)
endif
.PHONY: papers
