"""Measured speed against measured accuracy: the same scene with several engines and settings, errors and seconds.

`timed_run`   one way of running a scene, and the errors and the cost of one run
`repetition`  the order of the runs, so that all fit into a budget of time
`tradeoff`    all ways of running a scene, and the dataset with their errors and costs
"""
