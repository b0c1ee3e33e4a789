"""Lower bounds on the least collapse multiplier of joints that slide without dilatancy."""
