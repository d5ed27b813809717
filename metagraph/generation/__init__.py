"""Motion for conversations that is learned from takes and made from speech (Taylor et al. 2021, and beyond).

Using a model needs NumPy alone; only `training` may know torch.
"""
