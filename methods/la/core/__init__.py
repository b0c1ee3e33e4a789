"""The problem of a wall in limit analysis: yield domain and flow, its matrix, programmes over forces, states."""
