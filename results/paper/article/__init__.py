"""Pages and figures of results/paper."""
