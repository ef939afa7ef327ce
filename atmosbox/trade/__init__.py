"""Speed against accuracy, measured, and the cases in which simulations break.

`tradeoff`  the same scene through engines and settings, errors beside seconds
`extremes`  boxes that break simulations, and what each engine makes of them
"""
