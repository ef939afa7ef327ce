"""Measured speed against measured accuracy, and the extreme cases in which simulations fail.

`tradeoff`  the same scene with several engines and settings: errors and processor times
`extremes`  boxes that are difficult to simulate, and the outcome of each on each engine
"""
