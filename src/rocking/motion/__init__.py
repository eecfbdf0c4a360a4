"""Simulation of one block: its motion, events and the validity of the model."""
