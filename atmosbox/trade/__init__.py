"""Measured speed against measured accuracy: the same scene with several engines and settings, errors and seconds.

`timed_run`  one way of running a scene, the errors and the cost of one run, and the order of the runs
`tradeoff`   all ways of running a scene, and the dataset with their errors and costs
"""
