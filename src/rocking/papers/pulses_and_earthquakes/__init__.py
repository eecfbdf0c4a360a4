"""The rocking block under pulses and earthquakes: thresholds and numbers of five papers, 1963 to 2003.

The papers: Housner (1963), Shi et al. (1996), Makris & Roussos (2000), Zhang & Makris (2001), and Makris & Konstantinidis (2003).
"""
