"""How far what is measured can be trusted: against known targets, by simulation."""
