from PySide6.QtWidgets import QWidget


class MachinePanel(QWidget):
    def __init__(self, *a):
        super().__init__(a[-1])

    def show_problems(self, p):
        pass
